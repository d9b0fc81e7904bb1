// SPDX-License-Identifier: MIT
// `node build.mjs OUT_DIR` makes OUT_DIR/{index.html,page.js,page.css,report.js}, and parts.json: which packages are
// in them, with version and licence.
import { build } from 'esbuild';
import { copyFile, mkdir, readFile, writeFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';

const kMostBytes = 350_000; // gzipped, of all files together

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2];
if (!out) {
  console.error('usage: node build.mjs OUT_DIR');
  process.exit(2);
}
await mkdir(out, { recursive: true });
const { metafile } = await build({
  absWorkingDir: here,
  metafile: true,
  entryPoints: { page: 'src/main.ts', report: 'src/report/main.ts' },
  outdir: out,
  bundle: true,
  minify: true,
  format: 'iife', // a classic script can stand in a self-contained file
  target: 'es2022',
  charset: 'utf8',
  legalComments: 'none',
  logLevel: 'warning',
});
await build({
  absWorkingDir: here,
  entryPoints: { page: 'page.css' },
  outdir: out,
  bundle: true,
  minify: true,
  target: 'es2022',
  logLevel: 'warning',
});
const packages = new Set(
  Object.keys(metafile.inputs).flatMap((file) => /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(file)?.[1] ?? []),
);
const parts = [...packages].sort().map(async (name) => {
  const { version, license } = JSON.parse(await readFile(join(here, 'node_modules', name, 'package.json'), 'utf8'));
  return { name, version, license };
});
await writeFile(join(out, 'parts.json'), JSON.stringify(await Promise.all(parts), null, 2) + '\n');
await copyFile(join(here, 'index.html'), join(out, 'index.html'));

let total = 0;
for (const name of ['index.html', 'page.js', 'page.css', 'report.js']) {
  const bytes = gzipSync(await readFile(join(out, name)), { level: 9 }).length;
  console.log(`${name}: ${(bytes / 1000).toFixed(1)} kB gzipped`);
  total += bytes;
}
console.log(`all: ${(total / 1000).toFixed(1)} kB gzipped`);
if (total > kMostBytes) {
  console.error(`the page has more than ${kMostBytes / 1000} kB`);
  process.exit(1);
}
