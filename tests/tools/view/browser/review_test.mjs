// SPDX-License-Identifier: MIT
// A review is one file that shows the plan without a door.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import test, {after} from 'node:test';
import {pathToFileURL} from 'node:url';

import {browser, open_page} from './browser.mjs';
import {count_of_changes} from './png.mjs';
import {folder, open_door, request_file, scene_file} from './programs.mjs';

const kMostBytes = 5e6;

after(() => browser.close());

test('a review shows path and scene when the door is gone', async () => {
  const door = await open_door('--scene', scene_file('office'), '--request', request_file('office-graze-door'));
  const page = await open_page(door.url);
  await page.ready();
  await page.show_panel('File');
  const [download] = await Promise.all([page.tab.waitForEvent('download'), page.button('Save as a page').click()]);
  const file = path.join(folder, 'review.html');
  await download.saveAs(file);
  const answer = (await page.state()).answer;
  await page.close();
  assert.equal(await door.end(), 0, door.output);
  const bytes = fs.statSync(file).size;
  console.log(`# the review has ${bytes} bytes`);
  assert.ok(bytes < kMostBytes);

  const review = await open_page(pathToFileURL(file).href);
  await review.ready();
  await review.shows('ok');
  const state = await review.state();
  assert.equal(state.connection, 'review');
  assert.deepEqual(state.answer.segments, answer.segments);
  assert.equal(state.scene.scene.triangles, 29544);
  // Time goes on, and nothing can be edited.
  const start = await review.view();
  await review.tab.keyboard.press('End');
  await review.until(({state}) => state.cursor_s === state.answer.segments.at(-1).t1);
  assert.ok(count_of_changes(start, await review.view()) > 100, 'the picture does not follow the time');
  await review.tab.keyboard.press('k');
  assert.deepEqual((await review.state()).request, state.request);
  await review.close();
});
