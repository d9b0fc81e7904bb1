// SPDX-License-Identifier: MIT
// A plan in the office, as it is opened, dragged, played, and made from nothing.
import assert from 'node:assert/strict';
import test, {after} from 'node:test';

import {browser, open_page} from './browser.mjs';
import {count_of, count_of_changes} from './png.mjs';
import {open_door, request_file, scene_file} from './programs.mjs';

const kCollision = 0xd55e00;
const kBlended = 45;  // how far a colour is off that is seen through a wall
const kStray_px = 4;  // pixels of other lines whose blended colours are as near
const kSteps = 4;  // of a drag
const kSmall = {width: 960, height: 600};  // drawn sooner
// From the first keyframe of office-wall-rooms along z: there is the wall of the corridor, and there the corridor.
const kToWall_m = 2.55;
const kBeyondWall_m = 3.2;

const doors = [];
let graze_door;  // the page of two tests
after(async () => {
  await browser.close();
  for (const door of doors) assert.equal(await door.end(), 0, door.output);
});

async function open(request) {
  const words = request ? ['--request', request_file(request)] : [];
  const door = await open_door('--scene', scene_file('office'), ...words);
  doors.push(door);
  const page = await open_page(door.url, {window: kSmall});
  await page.ready();
  return page;
}

test('a request of the command line is shown with its answer', async () => {
  const page = graze_door = await open('office-graze-door');
  await page.shows('ok');
  await page.tab.getByText('Proved free', {exact: true}).waitFor();
  await page.tab.getByText(/^Certified: /).waitFor();
  await page.tab.getByText('Collisions before: 1').waitFor();
  const {answer} = await page.state();
  assert.ok(answer.certificate.certified);
  const text = await page.tab.locator('.cw-draws').innerText();
  assert.match(text, /^\d+ draws, [\d,]+ triangles/);
});

test('a keyframe that is dragged into a wall is red, and elsewhere the path is corrected and proved', async () => {
  const page = await open('office-wall-rooms');
  await page.shows('ok');
  const given = (await page.state()).request;
  const [x, y, z] = given.keyframes[0].position;
  const begin = await page.place_of([x, y, z]);
  const in_wall = await page.place_of([x, y, z + kToWall_m]);
  const beyond = await page.place_of([x, y, z + kBeyondWall_m]);
  assert.ok(count_of(await page.picture(begin), kCollision, kBlended) <= kStray_px, 'the keyframe is red already');
  const {mouse} = page.tab;
  await mouse.move(...begin);
  await mouse.down();
  await mouse.move(...in_wall, {steps: kSteps});
  await page.tab.locator('.cw-badge[data-status="invalid"] .cw-draft').waitFor();
  await page.tab.getByText(/^Keyframe 0 collides/).first().waitFor();
  await page.tab.locator('.labels [data-kind="invalid"]').waitFor();
  assert.ok(count_of(await page.picture(in_wall), kCollision, kBlended) > 20, 'the keyframe is not red');
  await mouse.move(...beyond, {steps: kSteps});
  await page.until(({state}) => !state.isPending && state.answer.status !== 'invalid');
  await mouse.up();
  await page.shows('ok');
  const {request, answer} = await page.state();
  assert.ok(Math.abs(request.keyframes[0].position[2] - (z + kBeyondWall_m)) < 0.05);
  assert.deepEqual(request.keyframes[1], given.keyframes[1]);
  assert.ok(answer.certificate.certified);
  assert.ok(answer.collisions.length > 0 && answer.remaining_collisions.length === 0);
  await page.has_no(page.tab.locator('.labels [data-kind="invalid"]'));
  // The whole drag is one step of undo.
  await page.tab.keyboard.press('Control+z');
  await page.until(({state}, z) => state.request.keyframes[0].position[2] === z, z);
  await page.shows('ok');
  // A keyframe that is selected is dragged level, too: the middle of its handles leaves it to that.
  await page.drawn();
  await mouse.move(...begin);
  await mouse.down();
  await mouse.move(...beyond, {steps: kSteps});
  await mouse.up();
  await page.until(({state}, to) => Math.abs(state.request.keyframes[0].position[2] - to) < 0.05, z + kBeyondWall_m);
  assert.ok(Math.abs((await page.state()).request.keyframes[0].position[1] - y) < 1e-9);
  await page.shows('ok');
  await page.close();
});

test('the time line scrubs and plays', async () => {
  const page = graze_door;
  const bar = await page.tab.getByRole('slider', {name: 'Time on the path'}).boundingBox();
  const {mouse} = page.tab;
  const start = await page.view();
  await mouse.move(bar.x + 0.25 * bar.width, bar.y + 0.6 * bar.height);
  await mouse.down();
  const early_s = (await page.state()).cursor_s;
  await mouse.move(bar.x + 0.75 * bar.width, bar.y + 0.6 * bar.height);
  await page.until(({state}, early_s) => state.cursor_s > early_s, early_s);
  await mouse.up();
  assert.ok(count_of_changes(start, await page.view()) > 100, 'the picture does not follow the time');
  const {cursor_s: begin_s, answer} = await page.state();
  await page.tab.keyboard.press('Home');
  await page.until(({state}, begin_s) => state.cursor_s < begin_s, begin_s);
  await page.button('Play').click();
  await page.until(({state}) => state.isPlaying && state.cursor_s > state.answer.segments[0].t0);
  await page.tab.keyboard.press('End');
  await page.until(({state}) => !state.isPlaying);
  assert.equal((await page.state()).cursor_s, answer.segments.at(-1).t1);
  await page.close();
});

test('keyframes of a shot are made with the keyboard alone', async () => {
  const page = await open();
  const {keyboard} = page.tab;
  await keyboard.press('c');  // no picture through the camera
  await keyboard.press('c');
  await keyboard.press('k');
  await page.until(({state}) => state.request.keyframes.length === 1);
  const {bounds} = (await page.state()).scene.scene;
  const middle = bounds.min.map((least, i) => (least + bounds.max[i]) / 2);
  const [x] = await page.place_of(middle);
  await keyboard.down('d');
  await page.until((camway, [x, middle]) => Math.abs((camway.screenOf(middle)?.[0] ?? Infinity) - x) > 150, [x, middle]);
  await keyboard.up('d');
  await keyboard.press('k');
  await page.shows('ok');
  assert.equal((await page.state()).request.keyframes.length, 2);
  await keyboard.press('Control+z');
  await page.until(({state}) => state.request.keyframes.length === 1 && !state.answer);
  await keyboard.press('Control+y');
  await page.shows('ok');
  // Panels are reached with Tab and arrows.
  const is_on_tab = () => page.tab.evaluate(() => document.activeElement?.getAttribute('role') === 'tab');
  for (let presses = 0; !(await is_on_tab()); ++presses) {
    assert.ok(presses < 60, 'Tab does not reach the panels');
    await keyboard.press('Tab');
  }
  await keyboard.press('ArrowRight');
  await page.tab.getByRole('tabpanel', {name: 'Keyframes'}).waitFor();
  await page.close();
});

test('where there is no way, the proof is shown', async () => {
  const page = await open('office-impossible-safe');
  await page.shows('infeasible');
  await page.tab.getByText('Why there is no path').waitFor();
  await page.tab.getByText(/^Keyframe 0 is inside a closed surface/).waitFor();
  await page.tab.locator('.labels span', {hasText: '0 inside'}).waitFor();
  await page.tab.locator('.labels span', {hasText: '1 outside'}).waitFor();
  assert.ok(count_of(await page.picture(), 0xcc79a7, 40) > 100, 'the closed surface is not lit');
  await page.close();
});
