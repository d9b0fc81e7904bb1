// SPDX-License-Identifier: MIT
// Use of the page beside dragging keyframes: handles, objects, storeys, exports, two tabs, and keys alone.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import test, {after} from 'node:test';
import {setTimeout as pause} from 'node:timers/promises';

import {browser, open_page as open_window} from './browser.mjs';
import {count_of_changes} from './png.mjs';
import {open_door, request_file, request_with, scene_file} from './programs.mjs';

const kSmall = {width: 960, height: 600};  // drawn sooner
const kHandleReach_px = 150;  // handles are looked for so far about what they move
const kHandleStep_px = 2;
const kSlow_ms = 100;
const kRounding_m = 1e-9;  // of sums and differences of heights
const kSinglePrecision = 1e-5;  // of metres and quaternions that the view computes with

const door = await open_door('--scene', scene_file('office'), '--request', request_file('office-wall-rooms'));
after(async () => {
  await browser.close();
  assert.equal(await door.end(), 0, door.output);
});

/// Opens the page without its pictures through the camera.
async function open_page(url) {
  const page = await open_window(url, {window: kSmall});
  await page.until(({state}) => state.scene);
  await page.tab.keyboard.press('c');
  await page.tab.keyboard.press('c');
  return page;
}

// One page for the tests that leave scene and request as they were: to load it is most of the work.
const shared = await open_page(door.url);

/// Returns the page with nothing selected and the answer in its panel.
async function shared_page() {
  await shared.ready();
  await shared.tab.keyboard.press('Escape');
  await shared.show_panel('Answer');
  return shared;
}

/// A place near another one where the mouse has one of these handles, and keeps it a few pixels farther on each side.
async function handle_about(page, about, wanted) {
  await page.drawn();
  const at = await page.tab.evaluate(([[x, y], wanted, reach, step]) => {
    const has = (name, x, y) => document.elementFromPoint(x, y)?.tagName === 'CANVAS' && window.camway.handleAt([x, y]) === name;
    for (let dx = -reach; dx <= reach; dx += step) {
      for (let dy = -reach; dy <= reach; dy += step) {
        const at = [x + dx, y + dy];
        const around = [[0, 0], [step, 0], [-step, 0], [0, step], [0, -step]];
        if (wanted.some(name => around.every(([i, j]) => has(name, at[0] + i, at[1] + j)))) return at;
      }
    }
  }, [about, wanted, kHandleReach_px, kHandleStep_px]);
  assert.ok(at, `there is no handle ${wanted} about ${about}`);
  return at;
}

async function drag(page, [x, y], [dx, dy]) {
  await page.tab.mouse.move(x, y);
  await page.tab.mouse.down();
  await page.tab.mouse.move(x + dx / 2, y + dy / 2);
  await page.tab.mouse.move(x + dx, y + dy);
  await page.tab.mouse.up();
}

test('a click names the part of a file, and handles turn a keyframe and leave it where it is', async () => {
  const page = await shared_page();
  await page.tab.mouse.click(...await page.place_of([9, 5.1, 8]));
  await page.until(({state}) => state.selection?.object === 'office');
  await page.tab.locator('.labels [data-kind="object"]', {hasText: /^office: \w+/}).waitFor();
  const {keyframes: [given]} = (await page.state()).request;
  await page.tab.keyboard.press('n');
  await page.button('Handles that turn').click();
  const at = await handle_about(page, await page.place_of(given.position), ['X', 'Y', 'Z', 'E']);
  await drag(page, at, [25, 25]);
  await page.until(({state}, given) => state.request.keyframes[0].orientation.some((x, i) => Math.abs(x - given[i]) > 0.01), given.orientation);
  const {keyframes: [turned]} = (await page.state()).request;
  turned.position.forEach((x, i) => assert.ok(Math.abs(x - given.position[i]) < 1e-9));
  assert.ok(Math.abs(Math.hypot(...turned.orientation) - 1) < 1e-9);
  await page.tab.keyboard.press('Control+z');
  await page.until(({state}, given) => state.request.keyframes[0].orientation.every((x, i) => x === given[i]), given.orientation);
});

test('a box is added, moved by the mouse and by keys, another tab shows it, and its mesh is sent once', async () => {
  const page = await shared_page();
  const other = await open_page(door.url);
  await other.ready();
  const fetched = [];
  for (const each of [page, other]) {
    each.tab.on('request', request => {
      if (request.url().includes('/meshes/')) fetched.push(each);
    });
  }
  await page.tab.bringToFront();
  let send_mesh;
  const is_sent = new Promise(done => (send_mesh = done));
  await page.tab.route(/\/meshes\//, route => is_sent.then(() => route.continue()));
  await page.button('Add a box where the view looks').click();
  const box_of = ({state}) => state.scene.objects.find(({name}) => name === 'box_1');
  const added = await page.until(box_of);
  await page.button('Handles that move').click();
  // The handles are there before the mesh is.
  const at = await handle_about(page, await page.place_of(added.position), ['X', 'Z', 'XZ']);
  send_mesh();
  await page.ready();
  await drag(page, at, [50, 40]);
  const moved = await page.until(({state}, before) => {
    const box = state.scene.objects.find(({name}) => name === 'box_1');
    return state.moves.size === 0 && box.position.some((x, i) => Math.abs(x - before[i]) > 0.05) && box;
  }, added.position);
  assert.equal(moved.mesh_digest, added.mesh_digest);
  await other.tab.bringToFront();
  await other.until(({state}, digest) => state.scene.objects.find(({name}) => name === 'box_1')?.digest === digest, moved.digest);
  await other.ready();
  assert.deepEqual([page, other].map(each => fetched.filter(by => by === each).length), [1, 1]);
  await page.tab.bringToFront();
  // Keys move and turn it, too, and each goes on from the one before, also where the scene answers later than they come.
  await page.tab.route(/\/v1\/scenes\/office$/, route => pause(kSlow_ms).then(() => route.continue()));
  for (const key of ['Alt+PageUp', 'Alt+PageUp', 'Alt+PageUp', 'Alt+PageUp', 'Alt+Shift+ArrowLeft']) {
    await page.tab.keyboard.press(key);
    await pause(kSlow_ms / 2);
  }
  const turned = Math.cos(2.5 * Math.PI / 180);
  await page.until(({state}, {height, turned, near}) => {
    const box = state.scene.objects.find(({name}) => name === 'box_1');
    return Math.abs(box.position[1] - height) < near && Math.abs(box.orientation[0] - turned) < near;
  }, {height: moved.position[1] + 0.2, turned, near: kSinglePrecision});
  await page.tab.unrouteAll({behavior: 'wait'});
  await page.tab.keyboard.press('Delete');
  await page.until(({state}) => state.scene.objects.length === 1);
  await other.close();
});

test('storeys are opened by buttons, and a window of another size shows all of the scene', async () => {
  const page = await shared_page();
  const storey = name => page.tab.locator(`[data-storey="${name}"]`);
  assert.ok(await storey('1').count() === 1, 'the office has two storeys');
  const pictures = [];
  for (const name of ['0', '1', 'all']) {
    await storey(name).click();
    await page.tab.locator(`[data-storey="${name}"][aria-pressed="true"]`).waitFor();
    pictures.push(await page.view());
  }
  assert.ok(count_of_changes(pictures[0], pictures[1]) > 1000 && count_of_changes(pictures[1], pictures[2]) > 1000);
  const canvas = () => page.tab.evaluate(() => {
    const {width, height} = document.querySelector('#viewport > canvas');
    const {clientWidth, clientHeight} = document.querySelector('#viewport');
    return {width, height, clientWidth, clientHeight, wide: document.documentElement.scrollWidth};
  });
  const wide = await canvas();
  await page.resize({width: 860, height: 560});
  const narrow = await canvas();
  assert.ok(narrow.width < wide.width);
  assert.deepEqual([narrow.width, narrow.height], [narrow.clientWidth, narrow.clientHeight]);
  assert.ok(narrow.wide <= 860);
  await page.place_of((await page.state()).request.keyframes[0].position);
  await page.resize(kSmall);
  assert.deepEqual(await canvas(), wide);
});

test('each export is chosen with the keyboard, and has its extension; what is refused is said', async () => {
  const page = await shared_page();
  await page.show_panel('File');
  const select = page.tab.getByRole('combobox', {name: 'Format'});
  const formats = await select.locator('option').evaluateAll(options => options.map(({value, text}) => ({value, text})));
  assert.ok(formats.length >= 10, JSON.stringify(formats));
  for (const {value, text} of formats) {
    await select.focus();
    await page.tab.keyboard.press('Home');
    for (let presses = 0; await select.inputValue() !== value; ++presses) {
      assert.ok(presses < formats.length);
      await page.tab.keyboard.press('ArrowDown');
    }
    await page.tab.keyboard.press('Tab');
    const [download] = await Promise.all([page.tab.waitForEvent('download'), page.tab.keyboard.press('Enter')]);
    const [, extension] = /\((\.\w+)\)/.exec(text);
    assert.equal(download.suggestedFilename(), `request${extension}`);
    assert.ok(fs.statSync(await download.path()).size > 100, value);
  }
  // The page shows a refusal of the door.
  await page.tab.route(/\/v1\/export/, route => route.continue({url: route.request().url().replace(/format=\w+/, 'format=none')}), {times: 1});
  await page.button('Export').click();
  await page.tab.locator('#message', {hasText: 'is none of'}).waitFor();
  await page.forgive(/400/);
});

test('keys alone lead from a path through a wall to one that is corrected and proved', async () => {
  const page = await shared_page();
  const {keyboard} = page.tab;
  await keyboard.press('n');
  const before = (await page.state()).request.keyframes[0].position;
  // A key that is held down makes drafts, as a drag does; let go, it is planned, and is one step of undo after the first.
  // Meanwhile the view keeps its size, whatever the bars say.
  await page.tab.evaluate(() => {
    window.sizes = [];
    new ResizeObserver(([{contentRect}]) => window.sizes.push(contentRect.height)).observe(document.querySelector('#viewport'));
  });
  const height_above_m = async () => (await page.state()).request.keyframes[0].position[1] - before[1];
  await keyboard.down('Alt');
  for (let i = 0; i < 4; ++i) await keyboard.down('PageUp');
  assert.ok((await page.state()).isDraft);
  await keyboard.up('PageUp');
  await keyboard.up('Alt');
  await page.until(({state}) => !state.isPending && !state.isDraft);
  const heights_m = [await height_above_m()];
  for (let i = 0; i < 2; ++i) {
    await keyboard.press('Control+z');
    heights_m.push(await height_above_m());
  }
  await page.drawn();
  assert.equal(new Set(await page.tab.evaluate(() => window.sizes)).size, 1);
  [0.2, 0.05, 0].forEach((height_m, i) => assert.ok(Math.abs(heights_m[i] - height_m) < kRounding_m, `${heights_m}`));
  for (const key of ['Alt+ArrowLeft', 'Alt+ArrowUp', 'Alt+PageUp', 'Alt+Shift+ArrowLeft']) await keyboard.press(key);
  await page.shows('ok');
  const {request, answer} = await page.state();
  assert.ok(Math.hypot(...request.keyframes[0].position.map((x, i) => x - before[i])) > 0.05);
  assert.ok(answer.collisions.length > 0 && answer.remaining_collisions.length === 0 && answer.certificate.certified);
  await page.tab.getByText(/^Certified: /).waitFor();
  await keyboard.press(']');
  await page.until(({state}) => state.answer.collisions.some(({witness}) => witness.time === state.cursor_s));
  // From above the whole building, V leads into it, and not onto its roof.
  await keyboard.press('Shift+h');
  await page.drawn();
  await keyboard.press('v');
  await page.drawn();
  await keyboard.press('k');
  const {keyframes, bounds} = await page.until(({state: {request: {keyframes}, scene}}) => keyframes.length === 3 && {keyframes, bounds: scene.scene.bounds});
  keyframes[2].position.forEach((x, i) => assert.ok(bounds.min[i] < x && x < bounds.max[i], `${keyframes[2].position}`));
  await page.close();
});

test('a page that may only read shows and plans, and changes no scene', async () => {
  const reading = await open_door('--read-only', '--scene', scene_file('office'), '--request', request_file('office-graze-door'));
  const page = await open_page(reading.url);
  await page.ready();
  await page.tab.getByText(/read only$/).waitFor();
  await page.show_panel('Scene');
  await page.tab.getByRole('list', {name: 'Objects'}).waitFor();
  assert.ok(!await page.tab.getByRole('form', {name: 'Add an object'}).isVisible());
  await page.tab.keyboard.press('b');
  await page.tab.keyboard.press('n');
  const given = (await page.state()).request.keyframes[0].position[1];
  await page.tab.keyboard.press('Alt+PageUp');
  await page.until(({state}, given) => state.request.keyframes[0].position[1] > given && !state.isPending && state.answer?.status === 'ok', given);
  const {scene} = await page.state();
  assert.deepEqual([scene.scene.revision, scene.objects.length], [1, 1]);
  await page.close();
  assert.equal(await reading.end(), 0, reading.output);
});

test('a path that is corrected in part says what remains, and why', async () => {
  const request = request_with('office-graze-column', {max_inserted_keyframes: 0});
  const partial = await open_door('--scene', scene_file('office'), '--request', request);
  const page = await open_page(partial.url);
  await page.ready();
  await page.shows('partial');
  const {answer} = await page.state();
  assert.ok(answer.remaining_collisions.length > 0 && !answer.certificate?.certified);
  await page.tab.getByText(`Remaining collisions: ${answer.remaining_collisions.length}`).waitFor();
  assert.equal(await page.tab.locator('.cw-remaining li', {hasText: 'not corrected'}).count(), answer.remaining_collisions.length);
  await page.tab.getByText(/nothing was corrected/).first().waitFor();
  assert.equal(await page.tab.getByText(/^(Certified|Proved)/).count(), 0);
  await page.close();
  assert.equal(await partial.end(), 0, partial.output);
});
