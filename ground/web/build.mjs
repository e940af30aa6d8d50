// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// node build.mjs [FOLDER [SOURCES]]: bundles the page of SOURCES (default: here) into FOLDER (default: dist), with the
// packages that stand beside this file. The same sources give the same octets. The 3D part is a chunk of its own. Names hold the hash
// of what is in the file, so that a browser keeps it for good; each file stands there compressed as well (docs/adr/0100).
import {build} from 'esbuild';
import {cpSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {basename, dirname, join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';
import {brotliCompressSync, constants, gzipSync} from 'node:zlib';
import {font_names, subset} from './fonts.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const out = resolve(process.argv[2] ?? join(here, 'dist'));
const sources = resolve(process.argv[3] ?? here);
rmSync(out, {recursive: true, force: true});
mkdirSync(out, {recursive: true});

/// The typefaces of style.css: `font:NAME` is the part of it that the page needs, made here of the package's whole file.
const fonts = {name: 'fonts', setup(bundler) {
  bundler.onResolve({filter: /^font:/}, ({path}) => ({path: path.slice('font:'.length), namespace: 'font'}));
  bundler.onLoad({filter: /.*/, namespace: 'font'}, async ({path}) => ({contents: await subset(join(here, 'node_modules'), path.replace('.woff2', '')), loader: 'file'}));
}};

const common = {absWorkingDir: sources, nodePaths: [join(here, 'node_modules')], outdir: out, bundle: true, format: 'esm', target: 'es2022', minify: true,
  legalComments: 'linked', logLevel: 'warning'};
const {metafile} = await build({...common, entryPoints: {main: 'page/main.js', style: 'page/style.css'}, entryNames: '[name]-[hash]',
  assetNames: '[name]-[hash]', splitting: true, plugins: [fonts], metafile: true});
await build({...common, entryPoints: {feed_worker: 'page/feed_worker.js'}});

const made = Object.entries(metafile.outputs).map(([path, {entryPoint}]) => ({name: basename(path), entry: entryPoint}));
const entry = (source) => made.find((one) => one.entry === source).name;
// The 3D part comes while the rest starts: most visits begin with the robot, and its code is most of the octets.
const drawing = made.find(({name}) => /^robot_drawing-.*\.js$/.test(name)).name;
const font_files = made.filter(({name}) => name.endsWith('.woff2')).map(({name}) => name).sort();
// What the page begins with is asked for at once, and not when the file that needs it has come.
const needed = Object.entries(metafile.outputs).find(([, {entryPoint}]) => entryPoint === 'page/main.js')[1].imports.filter(({kind}) => kind === 'import-statement').map(({path}) => basename(path));
// Octets and log lines alone are in the other typeface: it comes when they are seen.
const wanted_at_once = font_files.filter((name) => name.startsWith('inter'));
writeFileSync(join(out, 'index.html'), readFileSync(join(sources, 'page/index.html'), 'utf8')
    .replace('style.css', entry('page/style.css')).replace('main.js', entry('page/main.js'))
    .replace('</head>', `${wanted_at_once.map((name) => `  <link rel="preload" as="font" type="font/woff2" crossorigin href="${name}">\n`).join('')}` +
        [...needed, drawing].map((name) => `  <link rel="modulepreload" href="${name}">\n`).join('') + '</head>'));
cpSync(join(sources, 'page/icon.svg'), join(out, 'icon.svg'));

/// Notices of what is bundled: each licence asks to be carried along.
const notices = [];
for (const name of [...Object.keys(JSON.parse(readFileSync(join(here, 'package.json'))).dependencies), ...font_names]) {
  const folder = join(here, 'node_modules', name);
  const file = readdirSync(folder).find((one) => /^licen[cs]e/i.test(one));
  notices.push(
        `${name}\n${'='.repeat(name.length)}\n${file ? readFileSync(join(folder, file), 'utf8') : 'Apache-2.0'}`);
}
// The package of this typeface carries the licence of its style sheets; that of the letters is the one that Inter has, too.
notices.push(`JetBrains Mono\n==============\nCopyright 2020 The JetBrains Mono Project Authors\n\n${
  readFileSync(join(here, 'node_modules/inter-ui/LICENSE.txt'), 'utf8').replace(/^Copyright.*$/m, '').trim()}`);
writeFileSync(join(out, 'notices.txt'), notices.join('\n\n'));

let first = 0, all = 0;
for (const name of readdirSync(out).filter((one) => /\.(js|css|html|svg|txt)$/.test(one))) {
  const content = readFileSync(join(out, name));
  const zipped = gzipSync(content, {level: 9});
  const brotli = brotliCompressSync(content, {params: {[constants.BROTLI_PARAM_QUALITY]: 11, [constants.BROTLI_PARAM_SIZE_HINT]: content.length}});
  writeFileSync(join(out, `${name}.gz`), zipped);
  writeFileSync(join(out, `${name}.br`), brotli);
  if (!/\.(js|css|html)$/.test(name)) continue;
  all += brotli.length;
  if (!name.startsWith('robot_drawing')) first += brotli.length;
}
const letters = font_files.reduce((sum, name) => sum + readFileSync(join(out, name)).length, 0);
console.log(`ground page: ${(first / 1024).toFixed(0)} KiB without 3D, ${(all / 1024).toFixed(0)} KiB in all (brotli), typefaces ${(letters / 1024).toFixed(0)} KiB`);
