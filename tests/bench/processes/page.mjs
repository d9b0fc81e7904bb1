// SPDX-License-Identifier: MIT
// Measures the page of `camway view`, on the loopback.
//
//   node --experimental-websocket page.mjs PAGE_PACKAGES [--loads N] [--count N] [--house FILE] [--json FILE]
//
// ready   from the begin of the navigation until the whole scene with its plan is drawn, in a browser that keeps nothing:
//         the mark `camway-ready` of the page; there is no GPU, so Chromium draws with the processor, and with
//         CAMWAY_ANGLE=null not at all: that is the time without the drawing
// drag    from a draft of a drag until its answer is in the model of the page, one after the other, without drawing: the
//         planner, socket and store of the page, run by node
//
// PAGE_PACKAGES is the folder where the build made the page. CAMWAY, CAMWAY_BROWSER and CAMWAY_NPM are as for the tests of
// the page. Exit code: 0 measured, 1 not in time, 77 a part that it needs is not installed.
import {createRequire} from 'node:module';
import fs from 'node:fs';
import path from 'node:path';
import {pathToFileURL} from 'node:url';
import {parseArgs} from 'node:util';

import {browser, kWindow} from '../../tools/view/browser/browser.mjs';
import {write_large_scene} from '../../tools/view/browser/large_scene.mjs';
import {folder, kPatience_ms, kRoot, open_door, request_file, scene_file} from '../../tools/view/browser/programs.mjs';

const kMustBeReady_ms = {office: 1000, house: 2000, million: 4000};
const kMustAnswer_ms = 33;

const {values: flags, positionals: [packages]} = parseArgs({
  allowPositionals: true,
  options: {loads: {type: 'string', default: '9'}, count: {type: 'string', default: '200'}, house: {type: 'string'}, json: {type: 'string'}},
});

function quantile(times_ms, share) {
  const ordered = [...times_ms].sort((a, b) => a - b);
  return ordered[Math.min(Math.floor(share * ordered.length), ordered.length - 1)];
}

function row_of(name, times_ms, must_ms) {
  const [p50, p95] = [quantile(times_ms, 0.5), quantile(times_ms, 0.95)];
  const cells = [name.padEnd(28), ...[p50, p95, Math.max(...times_ms), must_ms].map(x => x.toFixed(x < 100 ? 1 : 0).padStart(8)), String(times_ms.length).padStart(6)];
  console.log(cells.join(' '));
  return {name, p50_ms: p50, p95_ms: p95, must_ms, count: times_ms.length};
}

/// Loads the page of a door with an empty cache, and returns the time until it is drawn.
async function time_of_load(url) {
  const context = await browser.newContext({viewport: kWindow});
  const tab = await context.newPage();
  await tab.addInitScript(() => {
    window.ready = new Promise(done => new PerformanceObserver(list => {
      for (const {name, startTime} of list.getEntries()) {
        if (name === 'camway-ready') done(startTime);
      }
    }).observe({type: 'mark', buffered: true}));
  });
  await tab.goto(url);
  const time_ms = await tab.evaluate(patience_ms => Promise.race([window.ready, new Promise(done => setTimeout(done, patience_ms))]), kPatience_ms);
  await context.close();
  if (typeof time_ms !== 'number') throw new Error(`${url} is not drawn after ${kPatience_ms} ms`);
  return time_ms;
}

async function measure_ready(name, must_ms, ...words) {
  const door = await open_door(...words);
  const times_ms = [];
  for (let i = 0; i < Number(flags.loads); ++i) times_ms.push(await time_of_load(door.url));
  await door.end();
  return row_of(`ready, ${name}`, times_ms, must_ms);
}

/// The parts of the page that plan, bundled for node.
async function planning_parts() {
  const {buildSync} = createRequire(path.join(packages, 'package.json'))('esbuild');
  const source = path.join(folder, 'parts.ts');
  const lines = [['Planner', 'door/planner'], ['DoorSocket', 'door/socket'], ['Store, kEmptyState', 'model/store']].map(
      ([names, file]) => `export {${names}} from ${JSON.stringify(path.join(packages, 'src', `${file}.ts`))};`);
  fs.writeFileSync(source, lines.join('\n'));
  const outfile = path.join(folder, 'parts.mjs');
  buildSync({entryPoints: [source], outfile, bundle: true, format: 'esm', platform: 'node', target: 'es2022'});
  return import(pathToFileURL(outfile));
}

/// Returns a function that waits until the store holds what a condition asks for, one at a time.
function waiter_of(store) {
  let look = () => undefined;
  store.listen(() => look());
  return condition => new Promise(done => {
    look = () => {
      if (condition(store.now)) done();
    };
    look();
  });
}

async function measure_drag({Planner, DoorSocket, Store, kEmptyState}, name) {
  const door = await open_door('--scene', scene_file('office'));
  const {origin, host, searchParams} = new URL(door.url);
  const token = searchParams.get('token');
  const store = new Store({...kEmptyState});
  const socket = new DoorSocket(`ws://${host}/v1/socket?token=${token}`, is_open => store.set({connection: is_open ? 'open' : 'lost'}));
  const interpolated = async request => {
    const response = await fetch(`${origin}/v1/interpolate`, {method: 'POST', headers: {authorization: `Bearer ${token}`}, body: JSON.stringify(request)});
    return (await response.json()).segments;
  };
  const planner = new Planner(socket, store, interpolated);
  planner.hasProfile = true;
  const until = waiter_of(store);
  socket.open();
  await until(({connection}) => connection === 'open');
  const given = JSON.parse(fs.readFileSync(request_file(name), 'utf8'));
  const times_ms = [];
  for (let i = 0; i < Number(flags.count); ++i) {
    const request = structuredClone(given);
    request.keyframes[1].position[1] += 1e-4 * (i % 50);
    store.set({request, answer: undefined});
    const begin_ms = performance.now();
    planner.plan(request, 'draft');
    await until(({answer, isPending}) => answer !== undefined && !isPending);
    times_ms.push(performance.now() - begin_ms);
  }
  await door.end();
  return row_of(`drag, ${name}`, times_ms, kMustAnswer_ms);
}

const rows = [];
console.log(`${''.padEnd(28)} ${['p50', 'p95', 'most', 'must'].map(word => word.padStart(8)).join(' ')} ${'of'.padStart(6)}  ms`);
const parts = await planning_parts();
const grazing = fs.readdirSync(path.join(kRoot, 'scenes/requests')).filter(file => /^office-graze-.*\.json$/.test(file)).sort();
for (const file of grazing) rows.push(await measure_drag(parts, path.basename(file, '.json')));
rows.push(await measure_ready('office', kMustBeReady_ms.office, '--scene', scene_file('office'), '--request', request_file('office-graze-door')));
if (flags.house && fs.existsSync(flags.house)) rows.push(await measure_ready('house', kMustBeReady_ms.house, '--scene', flags.house));
else console.log('ready, house: not measured; --house FILE says where one is');
const {scene, request} = write_large_scene(folder, 'hills', 1e6);
rows.push(await measure_ready('10^6 triangles', kMustBeReady_ms.million, '--scene', scene, '--request', request));
await browser.close();
if (flags.json) fs.writeFileSync(flags.json, JSON.stringify(rows, null, 1));
const late = rows.filter(({p95_ms, must_ms}) => p95_ms > must_ms);
console.log(late.length ? `too late: ${late.map(({name}) => name).join('; ')}` : 'all in time');
process.exit(late.length ? 1 : 0);
