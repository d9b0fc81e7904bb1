// SPDX-License-Identifier: MIT
// Packs the files of the page, and writes the policy of a file that holds all of them: `node pack.mjs OUT_DIR`.
import { createHash } from 'node:crypto';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';

const [, , out] = process.argv;
const read = (name) => readFileSync(join(out, name));

// A file that holds them all begins and ends scripts and styles by these words.
for (const name of ['page.js', 'page.css']) {
  if (/<\/(script|style)|<!--/i.test(read(name).toString())) throw new Error(`${name} ends the element that holds it`);
}
for (const name of ['index.html', 'page.js', 'page.css']) {
  writeFileSync(join(out, `${name}.gz`), gzipSync(read(name), { level: 9 }));
}

// No network, and no script or style but these.
const hash = (name) => `'sha256-${createHash('sha256').update(read(name)).digest('base64')}'`;
writeFileSync(
  join(out, 'policy.txt'),
  [
    "default-src 'none'",
    `script-src ${hash('page.js')} 'wasm-unsafe-eval'`,
    `style-src ${hash('page.css')}`,
    'img-src data: blob:',
    "base-uri 'none'",
    "form-action 'none'",
  ].join('; '),
);
