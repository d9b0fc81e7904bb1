// SPDX-License-Identifier: MIT
// What the tests of written files share: the packages, the program, and paths to export.
import {spawnSync} from 'node:child_process';
import fs from 'node:fs';
import {createRequire} from 'node:module';
import os from 'node:os';
import path from 'node:path';

/// The folder of scenes.
export const scenes = path.resolve(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname),
                                   '../../../scenes');

/// Loads a package of package-lock.json.
export const load = createRequire(path.join(process.env.CAMWAY_NPM, 'package.json'));

export const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'camway-npm-'));
process.on('exit', () => fs.rmSync(folder, {recursive: true}));

/// Runs camway, and returns what it printed. Throws where its exit code is not 0.
export function camway(...words) {
  const run = spawnSync(process.env.CAMWAY, words, {encoding: 'utf8', maxBuffer: 1 << 28});
  if (run.status !== 0) throw new Error(`camway ${words.join(' ')}: ${run.status}\n${run.stderr}`);
  return run.stdout;
}

/// A path through the office: the request, the answer, and a function that exports it.
export function plan(name) {
  const request = path.join(scenes, 'requests', `${name}.json`);
  const response = path.join(folder, `${name}.json`);
  camway('plan', '--request', request, '--response', response);
  const write = (file, ...words) => {
    const out = path.join(folder, file);
    camway('export', response, '--request', request, '--out', out, ...words);
    return fs.readFileSync(out);
  };
  return {request, response, write};
}
