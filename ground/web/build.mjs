// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// node build.mjs [FOLDER [SOURCES]]: bundles the page of SOURCES (default: here) into FOLDER (default: dist), with the
// packages that stand beside this file. The same sources give the same octets. The 3D part is a chunk of its own.
import {build} from 'esbuild';
import {cpSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {dirname, join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';
import {gzipSync} from 'node:zlib';

const here = dirname(fileURLToPath(import.meta.url));
const out = resolve(process.argv[2] ?? join(here, 'dist'));
const sources = resolve(process.argv[3] ?? here);
rmSync(out, {recursive: true, force: true});
mkdirSync(out, {recursive: true});

await build({
  absWorkingDir: sources,
  nodePaths: [join(here, 'node_modules')],
  entryPoints: {main: 'page/main.js', feed_worker: 'page/feed_worker.js', style: 'page/style.css'},
  outdir: out,
  bundle: true,
  splitting: true,
  format: 'esm',
  target: 'es2022',
  minify: true,
  legalComments: 'linked',
  logLevel: 'warning',
});
// The 3D part comes while the rest starts: most visits begin with the robot, and its code is most of the octets.
const drawing = readdirSync(out).find((name) => /^robot_drawing-.*\.js$/.test(name));
writeFileSync(join(out, 'index.html'), readFileSync(join(sources, 'page/index.html'), 'utf8')
    .replace('</head>', `  <link rel="modulepreload" href="${drawing}">\n</head>`));
cpSync(join(sources, 'page/icon.svg'), join(out, 'icon.svg'));

/// Notices of what is bundled: each licence asks to be carried along.
const notices = [];
for (const name of Object.keys(JSON.parse(readFileSync(join(here, 'package.json'))).dependencies)) {
  const folder = join(here, 'node_modules', name);
  const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
  notices.push(
        `${name}\n${'='.repeat(name.length)}\n${file ? readFileSync(join(folder, file), 'utf8') : 'Apache-2.0'}`);
}
writeFileSync(join(out, 'notices.txt'), notices.join('\n\n'));

let first = 0, all = 0;
for (const entry of readdirSync(out).filter((name) => /\.(js|css|html)$/.test(name))) {
  const octets = gzipSync(readFileSync(join(out, entry))).length;
  all += octets;
  if (!entry.startsWith('robot_drawing')) first += octets;
}
console.log(`ground page: ${(first / 1024).toFixed(0)} KiB without 3D, ${(all / 1024).toFixed(0)} KiB in all (gzip)`);
