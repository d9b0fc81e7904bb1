// SPDX-License-Identifier: MIT
// A page of another origin, in the browser that has the door's cookie, gets nothing and changes nothing.
import assert from 'node:assert/strict';
import http from 'node:http';
import test, {after} from 'node:test';

import {browser, open_page} from './browser.mjs';
import {kPatience_ms, open_door, request_file, scene_file} from './programs.mjs';

const door = await open_door('--scene', scene_file('office'), '--request', request_file('office-graze-door'));
const {origin, host} = new URL(door.url);
const server = http.createServer((_, answer) => answer.setHeader('content-type', 'text/html').end('<!doctype html>'));
await new Promise(done => server.listen(0, '127.0.0.1', done));
const foreign_url = `http://127.0.0.1:${server.address().port}/`;

after(async () => {
  await browser.close();
  server.close();
  assert.equal(await door.end(), 0, door.output);
});

/// Asks the door from a page of its own or another one, as its scripts can. Returns what each question came to.
function ask_from(tab) {
  return tab.evaluate(async ({origin, host}) => {
    const asked = (path, options) => fetch(origin + path, {credentials: 'include', ...options})
        .then(({status}) => status, () => 'refused');
    const crate = JSON.stringify({name: 'crate', form: {type: 'sphere', radius_m: 1}, position: [1, 1, 1]});
    const style = await new Promise(done => {
      const link = document.createElement('link');
      link.onload = () => done('loaded');
      link.onerror = () => done('refused');
      link.rel = 'stylesheet';
      link.href = `${origin}/page.css`;
      document.head.append(link);
    });
    const socket = await new Promise(done => {
      const made = new WebSocket(`ws://${host}/v1/socket`);
      made.onopen = () => done('open');
      made.onerror = () => done('refused');
    });
    return {
      read: await asked('/v1/scenes'),
      simple_post: await asked('/v1/scenes/office/objects', {method: 'POST', mode: 'no-cors', body: crate}),
      post: await asked('/v1/scenes/office/objects', {method: 'POST', body: crate}),
      style,
      socket,
    };
  }, {origin, host});
}

async function revision() {
  const headers = {authorization: `Bearer ${new URL(door.url).searchParams.get('token')}`};
  return (await (await fetch(`${origin}/v1/scenes/office`, {headers})).json()).scene.revision;
}

test('the page itself may ask', async () => {
  const page = await open_page(door.url);
  await page.ready();
  const before = await revision();
  const got = await ask_from(page.tab);
  assert.deepEqual(got, {read: 200, simple_post: 200, post: 200, style: 'loaded', socket: 'open'});
  assert.equal(await revision(), before + 2);
  await page.close();
});

test('a page of another port is refused', async () => {
  const page = await open_page(door.url);
  await page.ready();
  const before = await revision();
  const other = await page.tab.context().newPage();
  await other.goto(foreign_url);
  const got = await ask_from(other);
  assert.deepEqual(got, Object.fromEntries(Object.keys(got).map(question => [question, 'refused'])));
  assert.equal(await revision(), before);
  await page.close();
});

test('a page of another port cannot show the page in a frame', async () => {
  const page = await open_page(door.url);
  await page.ready();
  const other = await page.tab.context().newPage();
  await other.goto(foreign_url);
  const refusal = other.waitForEvent('console', {predicate: message => /frame-ancestors/.test(message.text()), timeout: kPatience_ms});
  await other.evaluate(url => {
    const frame = document.createElement('iframe');
    frame.src = url;
    document.body.append(frame);
  }, origin);
  await refusal;
  await page.close();
});

test('without the token nothing is shown, and the cookie is enough', async () => {
  const page = await open_page(door.url);
  await page.ready();
  const again = await page.tab.context().newPage();
  assert.equal((await again.goto(origin)).status(), 200);
  await page.close();
  const stranger = await browser.newContext();
  assert.equal((await (await stranger.newPage()).goto(origin)).status(), 403);
  await stranger.close();
});
