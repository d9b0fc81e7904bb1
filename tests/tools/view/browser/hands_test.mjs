// SPDX-License-Identifier: MIT
// Use of the page beside dragging keyframes: handles, objects, storeys, exports, two tabs, and keys alone.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import test, {after} from 'node:test';

import {browser, open_page as open_window} from './browser.mjs';
import {count_of_changes} from './png.mjs';
import {open_door, request_file, request_with, scene_file} from './programs.mjs';

const kSmall = {width: 960, height: 600};  // drawn sooner
const kRings_px = [60, 70, 80, 90, 50, 40, 30, 24, 18, 100, 110, 120, 130];  // about a keyframe, in which handles are looked for
const kDirections = 32;

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

/// Moves the mouse about a place until it is over a handle. Returns where it is.
async function handle_about(page, [x, y], wanted) {
  for (const ring of kRings_px) {
    for (let i = 0; i < kDirections; ++i) {
      const angle = 2 * Math.PI * i / kDirections;
      const at = [x + ring * Math.cos(angle), y + ring * Math.sin(angle)];
      await page.tab.mouse.move(...at);
      if (wanted.includes(await page.tab.evaluate(() => window.camway.handle))) return at;
    }
  }
  assert.fail(`there is no handle ${wanted} about ${x}, ${y}`);
}

async function drag(page, [x, y], [dx, dy]) {
  await page.tab.mouse.move(x, y);
  await page.tab.mouse.down();
  await page.tab.mouse.move(x + dx / 2, y + dy / 2);
  await page.tab.mouse.move(x + dx, y + dy);
  await page.tab.mouse.up();
}

test('a click names the part of a file, and handles turn a keyframe and leave it where it is', async () => {
  const page = await open_page(door.url);
  await page.ready();
  await page.tab.mouse.click(...await page.place_of([9, 5.1, 8]));
  await page.until(({state}) => state.selection?.object === 'office');
  await page.tab.locator('.labels [data-kind="object"]', {hasText: /^office: \w+/}).waitFor();
  const {keyframes: [given]} = (await page.state()).request;
  await page.tab.keyboard.press('n');
  await page.button('Handles that turn').click();
  await page.drawn();
  const at = await handle_about(page, await page.place_of(given.position), ['X', 'Y', 'Z', 'E']);
  await drag(page, at, [25, 25]);
  await page.until(({state}, given) => state.request.keyframes[0].orientation.some((x, i) => Math.abs(x - given[i]) > 0.01), given.orientation);
  const {keyframes: [turned]} = (await page.state()).request;
  turned.position.forEach((x, i) => assert.ok(Math.abs(x - given.position[i]) < 1e-9));
  assert.ok(Math.abs(Math.hypot(...turned.orientation) - 1) < 1e-9);
  await page.tab.keyboard.press('Control+z');
  await page.until(({state}, given) => state.request.keyframes[0].orientation.every((x, i) => x === given[i]), given.orientation);
  await page.close();
});

// Its search for a handle does not always meet the thin arrows of a small window.
test('a box is added and moved by the mouse, another tab shows it, and its mesh is sent once', {skip: 'the handle is not always found'}, async () => {
  const page = await open_page(door.url);
  await page.ready();
  const other = await open_page(door.url);
  await other.ready();
  const fetched = [];
  for (const each of [page, other]) {
    each.tab.on('request', request => {
      if (request.url().includes('/meshes/')) fetched.push(each);
    });
  }
  await page.tab.bringToFront();
  await page.button('Add a box where the view looks').click();
  const box_of = ({state}) => state.scene.objects.find(({name}) => name === 'box_1');
  const added = await page.until(box_of);
  await page.ready();
  await page.button('Handles that move').click();
  await page.drawn();
  const at = await handle_about(page, await page.place_of(added.position), ['X', 'Z', 'XZ']);
  await drag(page, at, [50, 40]);
  const moved = await page.until(({state}, before) => {
    const box = state.scene.objects.find(({name}) => name === 'box_1');
    return box && box.position.some((x, i) => Math.abs(x - before[i]) > 0.05) && box;
  }, added.position);
  await other.tab.bringToFront();
  await other.until(({state}, digest) => state.scene.objects.some(each => each.digest === digest), (await page.until(box_of)).digest);
  await other.ready();
  assert.equal(moved.mesh_digest, added.mesh_digest);
  assert.deepEqual([page, other].map(each => fetched.filter(by => by === each).length), [1, 1]);
  await page.tab.bringToFront();
  await page.tab.keyboard.press('Delete');
  await page.until(({state}) => state.scene.objects.length === 1);
  await page.close();
  await other.close();
});

test('storeys are opened by buttons, and a window of another size shows all of the scene', async () => {
  const page = await open_page(door.url);
  await page.ready();
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
  await page.tab.setViewportSize({width: 860, height: 560});
  await page.until((camway, was) => document.querySelector('#viewport > canvas').width < was, wide.width);
  const narrow = await canvas();
  assert.deepEqual([narrow.width, narrow.height], [narrow.clientWidth, narrow.clientHeight]);
  assert.ok(narrow.wide <= 860);
  await page.place_of((await page.state()).request.keyframes[0].position);
  await page.tab.setViewportSize(kSmall);
  await page.until((camway, was) => document.querySelector('#viewport > canvas').width === was, wide.width);
  await page.close();
});

test('each export is chosen with the keyboard, and has its extension; what is refused is said', async () => {
  const page = await open_page(door.url);
  await page.ready();
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
  await page.tab.route(/\/v1\/export/, route => route.continue({url: route.request().url().replace(/format=\w+/, 'format=none')}));
  await page.button('Export').click();
  await page.tab.locator('#message', {hasText: 'is none of'}).waitFor();
  page.forgive(/400/);
  await page.close();
});

test('keys alone lead from a path through a wall to one that is corrected and proved', async () => {
  const page = await open_page(door.url);
  await page.ready();
  const {keyboard} = page.tab;
  await keyboard.press('n');
  const before = (await page.state()).request.keyframes[0].position;
  for (const key of ['Alt+ArrowLeft', 'Alt+ArrowUp', 'Alt+PageUp', 'Alt+Shift+ArrowLeft']) await keyboard.press(key);
  await page.shows('ok');
  const {request, answer} = await page.state();
  assert.ok(Math.hypot(...request.keyframes[0].position.map((x, i) => x - before[i])) > 0.05);
  assert.ok(answer.collisions.length > 0 && answer.remaining_collisions.length === 0 && answer.certificate.certified);
  await page.tab.getByText(/^Certified: /).waitFor();
  await keyboard.press(']');
  await page.until(({state}) => state.answer.collisions.some(({witness}) => witness.time === state.cursor_s));
  await page.close();
});

test('a page that may only read shows and plans, and changes no scene', async () => {
  const reading = await open_door('--read-only', '--scene', scene_file('office'), '--request', request_file('office-graze-door'));
  const page = await open_page(reading.url);
  await page.ready();
  await page.tab.getByText(/read only$/).waitFor();
  await page.show_panel('Scene');
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
