// SPDX-License-Identifier: MIT
// The pictures of docs/view.md, written into the folder of CAMWAY_PICTURES. Nothing on them is cut off or overlaps.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import test, {after} from 'node:test';

import {browser, kWindow, open_page} from './browser.mjs';
import {small_png} from './png.mjs';
import {open_door, request_file, scene_file} from './programs.mjs';

const kMostBytes = 250000;
const kSmall = {width: 1024, height: 600};  // the least that everything must fit into
const kPictures = [
  {name: 'view-corrected', request: 'office-wall-rooms', at: 0.45},
  {name: 'view-dark', request: 'office-graze-slalom', at: 0.4, theme: 'dark'},
  {name: 'view-no-path', request: 'office-impossible-safe'},
  {name: 'view-camera', request: 'office-wall-tour', at: 0.3, keys: ['c']},
];

after(() => browser.close());

/// Elements that reach out of the window, or out of the box that clips them; tools of the view that overlap or are
/// covered; and pictures that do not fill their frame.
function faults_of_layout() {
  const faults = [];
  const name = element => `${element.tagName} ${element.className} "${(element.textContent ?? '').trim().slice(0, 30)}"`;
  const box = element => element.getBoundingClientRect();
  const shown = selector => [...document.querySelectorAll(selector)].filter(element => box(element).width > 0);
  for (const element of shown('body > *, #viewport > *, #bar-tools > *, .cw-tabs > *')) {
    const {left, top, right, bottom} = box(element);
    if (left < -1 || top < -1 || right > innerWidth + 1 || bottom > innerHeight + 1) faults.push(`out of the window: ${name(element)}`);
  }
  if (document.documentElement.scrollWidth > innerWidth) faults.push('the page is wider than the window');
  const tools = shown('.toolbar, .camera-views, .section-tool, .legend');
  tools.forEach((one, i) => tools.slice(i + 1).forEach(other => {
    const [a, b] = [box(one), box(other)];
    const is_apart = a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;
    if (!is_apart && document.querySelector('.camera-views').dataset.mode !== 'full') faults.push(`overlap: ${name(one)}, ${name(other)}`);
  }));
  for (const button of shown('button')) {
    if (button.scrollWidth > button.clientWidth + 1) faults.push(`cut off: ${name(button)}`);
  }
  for (const tool of shown(':is(#bar, #viewport) :is(button, input)')) {
    const {left, top, width, height} = box(tool);
    const met = document.elementFromPoint(left + width / 2, top + height / 2);
    if (!tool.contains(met)) faults.push(`covered: ${tool.getAttribute('aria-label')} by ${met && name(met)}`);
  }
  for (const picture of shown('.camera-views .picture')) {
    if (Math.abs(picture.clientWidth - picture.parentElement.clientWidth) > 1) faults.push('a picture does not fill its frame');
  }
  return faults;
}

for (const {name, request, at, theme, keys} of kPictures) {
  test(name, async () => {
    const door = await open_door('--scene', scene_file('office'), '--request', request_file(request));
    const page = await open_page(door.url, {theme});
    await page.ready();
    for (const key of keys ?? []) await page.tab.keyboard.press(key);
    if (at !== undefined) {
      const bar = await page.tab.getByRole('slider', {name: 'Time on the path'}).boundingBox();
      await page.tab.mouse.click(bar.x + (0.08 + 0.84 * at) * bar.width, bar.y + 0.6 * bar.height);
      await page.until(({state}) => state.cursor_s > state.answer.segments[0].t0);
      await page.tab.mouse.move(kWindow.width / 3, 2);  // no tooltip
    }
    await page.drawn();
    assert.deepEqual(await page.tab.evaluate(faults_of_layout), []);
    await page.resize(kSmall);
    assert.deepEqual(await page.tab.evaluate(faults_of_layout), [], `${kSmall.width} x ${kSmall.height}`);
    await page.resize(kWindow);
    const bytes = small_png(await page.picture());
    console.log(`# ${name}: ${bytes.length} bytes`);
    assert.ok(bytes.length < kMostBytes);
    fs.mkdirSync(process.env.CAMWAY_PICTURES, {recursive: true});
    fs.writeFileSync(path.join(process.env.CAMWAY_PICTURES, `${name}.png`), bytes);
    await page.close();
    assert.equal(await door.end(), 0, door.output);
  });
}
