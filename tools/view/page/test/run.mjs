// SPDX-License-Identifier: MIT
//
// Bundles the tests of the page with esbuild and runs them with `node --test`.
//
//   node test/run.mjs [OUT_DIR]      exit code: that of the tests
//
// CAMWAY_SOURCE is the folder of the project, by default the one that this file is in.

import { spawnSync } from 'node:child_process';
import { mkdtempSync, readdirSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const { buildSync } = createRequire(import.meta.url)('esbuild');
const kept = process.argv[2];
const out = kept ? resolve(kept) : mkdtempSync(join(tmpdir(), 'camway-page-test-'));

const tests = readdirSync(here, { recursive: true }).filter((name) => name.endsWith('.test.ts'));
try {
  buildSync({
    entryPoints: tests.map((name) => join(here, name)),
    outdir: out,
    outExtension: { '.js': '.mjs' },
    bundle: true,
    platform: 'node',
    format: 'esm',
    target: 'es2022',
    logLevel: 'warning',
  });
  const files = tests.map((name) => join(out, name.replace(/\.ts$/, '.mjs')));
  const environment = { CAMWAY_SOURCE: resolve(here, '../../../..'), ...process.env };
  const run = spawnSync(process.execPath, ['--test', ...files], { stdio: 'inherit', env: environment });
  process.exitCode = run.status ?? 1;
} finally {
  if (!kept) rmSync(out, { recursive: true, force: true });
}
