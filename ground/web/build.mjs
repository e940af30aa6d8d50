// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// node build.mjs [FOLDER [SOURCES]]: bundles the page of SOURCES (default: here) into FOLDER (default: dist), with the
// packages that stand beside this file. The same sources give the same octets. The 3D part is a chunk of its own. Names hold the hash
// of what is in the file, so that a browser keeps it for good; each file stands there compressed as well (docs/adr/0100).
import {build} from 'esbuild';
import {cpSync, mkdirSync, readdirSync, readFileSync, renameSync, rmSync, writeFileSync} from 'node:fs';
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

/// Of three.js what draws by a graphics card is for scene/card.js alone, and so a chunk that the first pictures do not wait for.
const three = {name: 'three', setup(bundler) {
  bundler.onResolve({filter: /^three$/}, ({importer}) => ({path: join(here, 'node_modules/three/build', basename(importer) === 'card.js' ? 'three.module.js' : 'three.core.js'), sideEffects: false}));
}};

/// Indents within templates are octets that no minifier may take; htm leaves out what is blank around a line's end.
const indents = {name: 'indents', setup(bundler) {
  bundler.onLoad({filter: /\/page\/.*\.js$/}, ({path}) => ({contents: readFileSync(path, 'utf8').replace(/>\n +</g, '><').replace(/\n +/g, '\n'), loader: 'js'}));
}};

const common = {absWorkingDir: sources, nodePaths: [join(here, 'node_modules')], outdir: out, bundle: true, format: 'esm', target: 'es2022', minify: true,
  legalComments: 'linked', logLevel: 'warning'};
const {metafile} = await build({...common, entryPoints: {main: 'page/main.js', style: 'page/style.css'}, entryNames: '[name]-[hash]',
  assetNames: '[name]-[hash]', splitting: true, plugins: [fonts, three, indents], metafile: true});
await build({...common, entryPoints: {feed_worker: 'page/feed_worker.js'}});

const outputs = Object.entries(metafile.outputs).map(([path, {entryPoint, imports}]) => ({name: basename(path), entry: entryPoint,
  needs: imports.filter(({kind}) => kind === 'import-statement').map((one) => basename(one.path))}));
const with_needs = (name) => [name, ...outputs.find((one) => one.name === name).needs.flatMap(with_needs)];
const entry = (source) => outputs.find((one) => one.entry === source).name;
// What the page begins with is asked for at once, and not when the file that needs it has come. The 3D part comes while the rest starts: most visits
// begin with the robot, and its code is most of the octets.
const of_page = new Set(with_needs(entry('page/main.js'))), drawing = outputs.find(({name}) => /^view-.*\.js$/.test(name)).name;
const of_robot = [...new Set(with_needs(drawing))].filter((name) => !of_page.has(name));
// What is the robot's alone says so by its name.
const said = (name) => of_robot.includes(name) ? name.replace(/^(chunk|view)-/, 'robot_space-') : name;
for (const {name} of outputs.filter((one) => one.name.endsWith('.js'))) {
  const text = readFileSync(join(out, name), 'utf8');
  const changed = of_robot.reduce((all, one) => all.replaceAll(one, said(one)), text);
  if (changed !== text) writeFileSync(join(out, name), changed);
  if (said(name) !== name) renameSync(join(out, name), join(out, said(name)));
}
const font_files = outputs.filter(({name}) => name.endsWith('.woff2')).map(({name}) => name).sort();
// Octets and log lines alone are in the other typeface: it comes when they are seen.
const wanted_at_once = font_files.filter((name) => name.startsWith('inter'));
writeFileSync(join(out, 'index.html'), readFileSync(join(sources, 'page/index.html'), 'utf8')
    .replace(/<!--.*-->\n/g, '')  // as of scripts and styles: whose it is stands beside it
    .replace('style.css', entry('page/style.css')).replace('main.js', entry('page/main.js'))
    .replace('</head>', `${wanted_at_once.map((name) => `  <link rel="preload" as="font" type="font/woff2" crossorigin href="${name}">\n`).join('')}` +
        [...[...of_page].filter((name) => name !== entry('page/main.js')), ...of_robot.map(said)].map((name) => `  <link rel="modulepreload" href="${name}">\n`).join('') + '</head>'));
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
  if (!/^(robot_|card)/.test(name)) first += brotli.length;
}
const letters = font_files.reduce((sum, name) => sum + readFileSync(join(out, name)).length, 0);
console.log(`ground page: ${(first / 1024).toFixed(0)} KiB without 3D, ${(all / 1024).toFixed(0)} KiB in all (brotli), typefaces ${(letters / 1024).toFixed(0)} KiB`);
