// SPDX-License-Identifier: MIT
// Programs that run beside a test: the door with its page, a daemon, and commands.
import {spawn, spawnSync} from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';

export const kRoot = path.resolve(path.dirname(new URL(import.meta.url).pathname), '../../../..');
/// Time after which a wait counts as failed. Every wait ends as soon as its condition holds.
export const kPatience_ms = 60000;
const kNotRun = 77;

export const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'camway-page-'));
const running = new Set();
process.on('exit', () => {
  for (const child of running) child.kill('SIGKILL');
  fs.rmSync(folder, {recursive: true, force: true});
});

export function scene_file(name) {
  return path.join(kRoot, 'scenes', `${name}.obj`);
}

export function request_file(name) {
  return path.join(kRoot, 'scenes/requests', `${name}.json`);
}

/// Writes a request with other options into the folder of the test, and returns its name.
export function request_with(name, options) {
  const request = JSON.parse(fs.readFileSync(request_file(name), 'utf8'));
  const file = path.join(folder, `${name}-${Object.keys(options).join('-')}.json`);
  fs.writeFileSync(file, JSON.stringify({...request, scene: 'office.obj', options: {...request.options, ...options}}));
  return file;
}

/// Ends the test as one that cannot run here, and says why.
export function not_run(why) {
  console.log(`not run: ${why}`);
  process.exit(kNotRun);
}

/// Runs camway to its end, and returns what it printed. Throws where its exit code is not 0.
export function camway(...words) {
  const run = spawnSync(process.env.CAMWAY, words, {encoding: 'utf8'});
  if (run.status !== 0) throw new Error(`camway ${words.join(' ')}: ${run.status}\n${run.stderr}`);
  return run.stdout;
}

/// A program that runs beside the test. It is killed when the test ends in any way, and keeps no test from ending:
/// one that fails leaves its programs running.
class Program {
  constructor(file, words) {
    this.output = '';
    this.child = spawn(file, words, {stdio: ['ignore', 'pipe', 'pipe']});
    running.add(this.child);
    this.waiting = [];
    this.child.unref();
    for (const stream of [this.child.stdout, this.child.stderr]) {
      stream.on('data', text => this.heard(text));
      stream.unref();
    }
    this.ended = new Promise(done => this.child.on('exit', (code, signal) => {
      running.delete(this.child);
      this.heard(`[ended: ${code ?? signal}]`);
      done(code ?? signal);
    }));
  }

  heard(text) {
    this.output += text;
    for (const look of this.waiting.slice()) look();
  }

  /// Waits until the output has `pattern`, and returns the match.
  prints(pattern) {
    return new Promise((done, fail) => {
      const leave = () => {
        clearTimeout(timer);
        this.waiting = this.waiting.filter(other => other !== look);
      };
      const look = () => {
        const match = pattern.exec(this.output);
        const is_over = /\[ended: /.test(this.output);
        if (!match && !is_over) return;
        leave();
        if (match) done(match);
        else fail(new Error(this.output));
      };
      const timer = setTimeout(() => {
        leave();
        fail(new Error(`${pattern} was not printed:\n${this.output}`));
      }, kPatience_ms);
      this.waiting.push(look);
      look();
    });
  }

  /// Sends a signal and waits for the end. Returns the exit code, or the name of the signal that ended it.
  end(signal = 'SIGTERM') {
    this.child.ref();
    this.child.kill(signal);
    return this.ended;
  }
}

/// Starts `camway view`, and returns it with the `url` that it printed. Ends the test as not run where the door has no
/// page with scripts, as Camway was built without npm.
export async function open_door(...words) {
  const door = new Program(process.env.CAMWAY, ['view', ...words]);
  [door.url] = await door.prints(/http:\/\/\S+token=\S+/);
  const {origin, searchParams} = new URL(door.url);
  const headers = {authorization: `Bearer ${searchParams.get('token')}`};
  const script = await fetch(`${origin}/page.js`, {headers});
  await script.arrayBuffer();
  if (script.status === 404) not_run('camway was built without its page');
  return door;
}

/// Starts a daemon that has the office, with its state so often that changes are told quickly.
export async function start_daemon() {
  const daemon = new Program(process.env.CAMWAYD, ['--scene', `office=${scene_file('office')}`]);
  await daemon.prints(/\[info\] ready/);
  return daemon;
}
