// SPDX-License-Identifier: MIT
// The page in a real browser, as a person has it: what is seen is read, mouse and keys are used.
import assert from 'node:assert/strict';
import {createRequire} from 'node:module';
import fs from 'node:fs';
import path from 'node:path';

import {kPatience_ms, not_run} from './programs.mjs';
import {read_png} from './png.mjs';
import {start_slow_network} from './slow_network.mjs';

// Other timing, to look for races: the page computes so many times slower, and answers and frames come up to so much later.
const kSlowdown = Number(process.env.CAMWAY_CPU_SLOWDOWN ?? 1);
const kAnswerDelay_ms = Number(process.env.CAMWAY_ANSWER_DELAY_MS ?? 0);
const kFrameDelay_ms = Number(process.env.CAMWAY_FRAME_DELAY_MS ?? 0);

const kBrowser = process.env.CAMWAY_BROWSER ?? '';
export const kWindow = {width: 1280, height: 720};

if (!fs.existsSync(kBrowser)) not_run('chromium-headless-shell is not installed');
const {chromium} = createRequire(path.join(process.env.CAMWAY_NPM, 'package.json'))('playwright-core');

// A test runs in a network of its own, often as the root of its own namespace: there is no sandbox inside of that.
// WebGL 2 is computed by SwiftShader, and without smooth edges: those take most of the time, and only pictures need them.
// With CAMWAY_ANGLE=null nothing is drawn, for measurements.
export const browser = await chromium.launch({
  executablePath: kBrowser,
  args: ['--no-sandbox', `--use-angle=${process.env.CAMWAY_ANGLE ?? 'swiftshader'}`, '--enable-unsafe-swiftshader',
         ...(process.env.CAMWAY_PICTURES ? [] : ['--webgl-antialias-mode=none']),
         // Without the second word a browser goes past the proxy to what is on its own machine.
         ...(kAnswerDelay_ms > 0 ? [`--proxy-server=${await start_slow_network(kAnswerDelay_ms)}`, '--proxy-bypass-list=<-loopback>'] : [])],
});

/// Opens the page of a door, or a file.
export async function open_page(url, {theme = 'light', window = kWindow, without_webgl = false} = {}) {
  // With less motion the view is at once where it goes: each frame on the way would take the time of a processor.
  const context = await browser.newContext({viewport: window, colorScheme: theme, acceptDownloads: true, reducedMotion: 'reduce'});
  context.setDefaultTimeout(kPatience_ms);
  const page = new Page(await context.newPage(), url);
  await delay(page.tab);
  if (without_webgl) await page.tab.addInitScript(() => (HTMLCanvasElement.prototype.getContext = () => null));
  await page.open();
  return page;
}

/// Gives a tab the timing of the environment.
async function delay(tab) {
  if (kSlowdown > 1) await (await tab.context().newCDPSession(tab)).send('Emulation.setCPUThrottlingRate', {rate: kSlowdown});
  if (kFrameDelay_ms > 0) await tab.addInitScript(delay_frames, kFrameDelay_ms);
}

function delay_frames(longest_ms) {
  const next_frame = window.requestAnimationFrame.bind(window);
  let waiting = [];
  const run_all = now_ms => {
    const all = waiting;
    waiting = [];
    for (const run of all) run(now_ms);
  };
  window.requestAnimationFrame = run => {
    if (waiting.push(run) === 1) setTimeout(() => next_frame(run_all), Math.random() * longest_ms);
    return 0;
  };
}

export class Page {
  constructor(tab, url) {
    this.tab = tab;
    this.whole = tab; // of a review in a frame, the tab that has the frame
    this.url = url;
    this.faults = [];
    this.forgiven = [];
    tab.on('pageerror', error => this.faults.push(`${error.stack ?? error}`));
    tab.on('console', message => {
      if (message.type() === 'error') this.faults.push(`console: ${message.text()}`);
    });
    // The test has each dialog for files, from the begin on: a key would overtake the wish for the next one.
    tab.on('filechooser', () => undefined);
    tab.on('request', request => this.expect_inside(request.url()));
    tab.on('websocket', socket => this.expect_inside(socket.url().replace(/^ws/, 'http')));
  }

  /// Nothing may be asked of anyone but the door.
  expect_inside(url) {
    const {protocol, origin} = new URL(url);
    const is_inside = ['blob:', 'data:'].includes(protocol) || url === this.url || origin === new URL(this.url).origin;
    if (!is_inside) this.faults.push(`asked ${url}`);
  }

  async open() {
    await this.tab.addInitScript(() => {
      addEventListener('securitypolicyviolation', ({violatedDirective, blockedURI}) => {
        console.error(`forbidden by ${violatedDirective}: ${blockedURI}`);
      });
      window.sockets = [];
      window.WebSocket = class extends WebSocket {
        constructor(...words) {
          super(...words);
          window.sockets.push(this);
        }
      };
    });
    await this.tab.goto(this.url);
  }

  /// The review that a report shows in its frame, to be asked as a page is.
  async review() {
    const frame = await (await this.tab.locator('iframe').elementHandle()).contentFrame();
    await frame.waitForURL('about:srcdoc');  // what is asked of the empty page before it is lost with that
    return Object.assign(Object.create(this), {tab: frame});
  }

  /// Waits for a fault that must happen, and takes all that are like it. The others fail the test at `close`.
  async forgive(pattern) {
    while (!this.faults.some(fault => pattern.test(fault))) await this.tab.waitForEvent('console');
    this.forgiven.push(pattern);
  }

  /// Has the door close the socket of the page: it takes no bytes that are not text. Returns the code of the close.
  drop_socket() {
    return this.tab.evaluate(() => {
      const socket = window.sockets.at(-1);
      const closed = new Promise(done => socket.addEventListener('close', ({code}) => done(code)));
      socket.send(new Uint8Array(1));
      return closed;
    });
  }

  async close() {
    await this.tab.context().close();
    assert.deepEqual(this.faults.filter(fault => !this.forgiven.some(pattern => pattern.test(fault))), []);
  }

  /// Waits until `condition(camway, argument)` is true in the page, which is asked for each frame. What it returns is
  /// returned. Not by Playwright's waitForFunction: that needs eval, which the page forbids.
  async until(condition, argument) {
    const value = await this.tab.evaluate(`(async () => {
      const condition = ${condition};
      const give_up_at_ms = performance.now() + ${kPatience_ms};
      while (performance.now() < give_up_at_ms) {
        const value = window.camway && condition(window.camway, ${JSON.stringify(argument)});
        if (value) return value;
        await new Promise(done => requestAnimationFrame(done));
      }
    })()`);
    if (value) return value;
    const seen = await this.tab.locator('body').innerText();
    const missing = await this.tab.evaluate(() => window.camway?.missing);
    throw new Error(`not seen: ${condition}\nNot drawn: ${missing}\nThe page says:\n${seen}\n${this.faults.join('\n')}`);
  }

  /// Waits until the scene is drawn and nothing is being planned. Returns the time since the page was asked for.
  ready() {
    return this.until(camway => {
      const {state, report} = camway;
      if (!state.scene || !['open', 'review'].includes(state.connection) || state.isPending || state.isDraft) return undefined;
      if (state.request?.keyframes.length >= 2 && !state.answer) return undefined;
      return report?.sceneTriangles >= state.scene.scene.triangles && performance.now();
    });
  }

  state() {
    return this.tab.evaluate(() => window.camway.state);
  }

  /// Waits until what was asked for last has an answer of this status, and the panel shows it.
  async shows(status) {
    await this.until(({state}, status) => !state.isPending && !state.isDraft && state.answer?.status === status, status);
    await this.tab.locator(`.cw-badge[data-status="${status}"]:not(:has(.cw-draft))`).waitFor();
  }

  /// Waits until nothing like this is shown.
  async has_no(locator) {
    await locator.filter({visible: true}).first().waitFor({state: 'hidden'});
  }

  /// Gives the window another size, and waits until all is drawn in it.
  async resize(window) {
    await this.tab.setViewportSize(window);
    await this.until((camway, {width, height}) => innerWidth === width && innerHeight === height, window);
    await this.drawn();
  }

  button(name) {
    return this.tab.getByRole('button', {name, exact: true});
  }

  async show_panel(name) {
    await this.tab.getByRole('tab', {name, exact: true}).click();
  }

  /// The place of a point of the world in the window, when all is drawn: the mouse meets what was drawn last.
  async place_of(point) {
    await this.drawn();
    const place = await this.tab.evaluate(at => window.camway.screenOf(at), point);
    assert.ok(place, `${point} is not in the view`);
    return place;
  }

  /// A picture of the window, or of the part about a place.
  async picture(about, reach = 20) {
    await this.drawn();
    const clip = about && {x: Math.round(about[0]) - reach, y: Math.round(about[1]) - reach, width: 2 * reach, height: 2 * reach};
    return read_png(await this.tab.screenshot({clip}));
  }

  /// A picture of the view of the scene alone: panels and time line change without it.
  async view() {
    await this.drawn();
    return read_png(await this.whole.screenshot({clip: await this.tab.locator('#viewport').boundingBox()}));
  }

  /// Waits until all requested frames are drawn, and one frame more, which puts it on the screen.
  async drawn() {
    await this.tab.evaluate(() => new Promise(requestAnimationFrame));
    await this.until(({missing}) => missing.length === 0);
    await this.tab.evaluate(() => new Promise(requestAnimationFrame));
  }
}
