// SPDX-License-Identifier: MIT
// Packs the files of the page, and writes the policies of files that hold them: of a review (policy.txt), and of a report
// with reviews in frames (report_policy.txt). `node pack.mjs OUT_DIR`.
import { createHash } from 'node:crypto';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';

const [, , out] = process.argv;
const read = (name) => readFileSync(join(out, name));

// A file that holds them all begins and ends scripts and styles by these words.
for (const name of ['page.js', 'page.css', 'report.js']) {
  if (/<\/(script|style)|<!--/i.test(read(name).toString())) throw new Error(`${name} ends the element that holds it`);
}
for (const name of ['index.html', 'page.js', 'page.css']) {
  writeFileSync(join(out, `${name}.gz`), gzipSync(read(name), { level: 9 }));
}

// No network, and no script but these.
const hash = (name) => `'sha256-${createHash('sha256').update(read(name)).digest('base64')}'`;
const policy = (scripts, styles) =>
  [
    "default-src 'none'",
    `script-src ${scripts.map(hash).join(' ')} 'wasm-unsafe-eval'`,
    `style-src ${styles}`,
    'img-src data: blob:',
    "base-uri 'none'",
    "form-action 'none'",
  ].join('; ');
writeFileSync(join(out, 'policy.txt'), policy(['page.js'], hash('page.css')));
// The style of a report is no part of the page. Its frames obey both policies.
writeFileSync(join(out, 'report_policy.txt'), policy(['report.js', 'page.js'], "'unsafe-inline'"));
