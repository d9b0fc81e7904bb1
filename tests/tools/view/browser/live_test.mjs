// SPDX-License-Identifier: MIT
// The page of a daemon's scene, which other processes change, and a daemon that is killed and comes back.
import assert from 'node:assert/strict';
import test, {after} from 'node:test';

import {browser, open_page} from './browser.mjs';
import {camway, open_door, request_file, start_daemon} from './programs.mjs';

let daemon = await start_daemon();
const door = await open_door('office', '--request', request_file('office-free-straight'));

after(async () => {
  await browser.close();
  assert.equal(await door.end(), 0, door.output);
  assert.equal(await daemon.end(), 0, daemon.output);
});

function revision(page) {
  return page.state().then(({scene}) => scene.scene.revision);
}

async function shows_revision(page, least) {
  await page.until(({state}, least) => state.scene.scene.revision >= least, least);
}

test('an object that another process moves breaks the watched path, and heals it', async () => {
  const page = await open_page(door.url);
  await page.shows('ok');
  await page.show_panel('Scene');
  await page.tab.getByRole('checkbox', {name: /watch/i}).check();
  await page.until(({state}) => state.watched === 'ok');
  await page.tab.getByText('watched path: free').waitFor();
  // The path is watched again after a lost connection.
  await page.drop_socket();
  await page.until(({state}) => window.sockets.length === 2 && state.connection === 'open' && state.watched === 'ok');
  const before = await revision(page);
  // A box that the last keyframe is shut in: any other obstacle would be gone round at once.
  camway('scene', 'add', 'office', 'box', '--box', '2,2,2', '--position=-20,8.9,10');
  await shows_revision(page, before + 1);
  await page.until(({state}) => state.watched === 'ok');
  await page.ready();
  const fetched = [];
  page.tab.on('request', request => {
    if (request.url().includes('/meshes/')) fetched.push(request.url());
  });
  camway('scene', 'move', 'office', 'box', '--position', '28,8.9,10');
  await shows_revision(page, before + 2);
  await page.until(({state}) => state.watched === 'broken' && state.answer.status === 'infeasible');
  await page.tab.getByText('watched path: broken').waitFor();
  camway('scene', 'move', 'office', 'box', '--position=-20,8.9,10');
  await shows_revision(page, before + 3);
  await page.until(({state}) => state.watched === 'ok' && state.answer.status === 'ok');
  await page.tab.getByText('watched path: free').waitFor();
  await page.ready();
  assert.deepEqual(fetched, [], 'a mesh that only moves is not sent again');
  assert.ok((await page.state()).answer.clearance_profile, 'answers to a watched path colour it, too');
  await page.close();
});

test('a daemon that is killed is missed, and found again', async () => {
  const page = await open_page(door.url);
  await page.shows('ok');
  assert.equal(await daemon.end('SIGKILL'), 'SIGKILL');
  await page.until(({state}) => state.connection === 'lost');
  await page.tab.getByText(/The daemon is not heard/).first().waitFor();
  await page.show_panel('File');
  assert.equal(await page.button('Save as a page').getAttribute('title'), 'Needs the connection to camway');
  await page.show_panel('Answer');
  daemon = await start_daemon();
  await page.until(({state}) => state.connection === 'open');
  await page.tab.getByText(/The daemon is not heard/).first().waitFor({state: 'detached'});
  await page.tab.keyboard.press('p');
  await page.shows('ok');
  await page.close();
});

test('a scene that the daemon has not is named, and no connection is said to be lost', async () => {
  const wrong = await open_door('offices');
  const page = await open_page(wrong.url);
  await page.tab.getByText(/there are: 'office'/).first().waitFor();
  await page.tab.locator('#status', {hasText: 'not connected yet'}).waitFor();
  await page.forgive(/404/);
  await page.close();
  assert.equal(await wrong.end(), 0, wrong.output);
});
