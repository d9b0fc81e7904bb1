// SPDX-License-Identifier: MIT
// A scene of 10^6 triangles: it is simplified for the picture, and the page says so.
import assert from 'node:assert/strict';
import test, {after} from 'node:test';

import {browser, open_page} from './browser.mjs';
import {write_large_scene} from './large_scene.mjs';
import {folder, open_door} from './programs.mjs';

after(() => browser.close());

test('a scene of a million triangles is shown', async () => {
  const {scene, request, triangles} = write_large_scene(folder, 'hills', 1e6);
  const door = await open_door('--scene', scene, '--request', request);
  const page = await open_page(door.url);
  await page.ready();
  await page.shows('ok');
  const [words, report] = [await page.tab.locator('.cw-draws').innerText(), await page.tab.evaluate(() => window.camway.report)];
  console.log(`# ${words}`);
  assert.equal(report.sceneTriangles, triangles);
  assert.ok(report.shownTriangles < triangles && report.error_m > 0, JSON.stringify(report));
  assert.ok(words.includes(`of ${triangles.toLocaleString('en')}`) && words.includes('simplified'), words);
  await page.close();
  assert.equal(await door.end(), 0, door.output);
});
