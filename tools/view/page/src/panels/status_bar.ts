// SPDX-License-Identifier: MIT
import type { Actions, DrawReport, Facts } from '../model/actions.js';
import { counted, durationText } from '../model/format.js';
import type { State, Store } from '../model/store.js';
import { stageTimes } from './answer_words.js';
import { make, makeButton, setText } from './dom.js';

export interface StatusBar {
  setFacts(facts: Facts): void;
  setDraws(report: DrawReport): void;
}

const kConnections: Readonly<Record<State['connection'], string>> = {
  connecting: 'not connected yet',
  open: 'connected',
  lost: 'connection lost, trying again',
  review: 'saved review: nothing can be changed',
};

const kWatched: Readonly<Record<State['watched'], string>> = {
  off: '',
  ok: 'watched path: free',
  broken: 'watched path: broken',
  replanning: 'watched path: planned again',
};

/** Makes the bar at the foot of the page: who plans, which scene, what goes on, and what took the time. */
export function makeStatusBar(host: HTMLElement, store: Store, actions: Actions): StatusBar {
  const connection = make('span', { class: 'cw-connection' });
  const scene = make('span', {});
  const watched = make('span', { class: 'cw-watched' });
  const space = make('span', { class: 'cw-space' });
  const cancel = makeButton('Cancel', () => actions.cancel(), { class: 'cw-cancel' });
  const stages = make('span', { class: 'cw-stages', role: 'img' });
  const took = make('span', { class: 'cw-took' });
  const draws = make('span', { class: 'cw-draws', title: 'What the picture is made of' });
  host.classList.add('cw-status');
  host.append(connection, scene, watched, space, cancel, stages, took, draws);
  let who = '';

  const update = (now: State): void => {
    host.dataset['connection'] = now.connection;
    setText(connection, now.connection === 'open' && who ? who : kConnections[now.connection]);
    const facts = now.scene?.scene;
    setText(scene, facts ? `${facts.name}, revision ${facts.revision}${now.isReadOnly ? ', read only' : ''}` : '');
    setText(watched, kWatched[now.watched]);
    watched.dataset['state'] = now.watched;
    const goesOn = now.isPending && !now.isDraft;
    cancel.hidden = !goesOn;
  };
  const updateTimes = (now: State): void => {
    const times = stageTimes(now.answer);
    const total = times.reduce((sum, { milliseconds }) => sum + milliseconds, 0);
    const words = times.map(({ stage, milliseconds }) => `${stage} ${durationText(milliseconds)}`).join(', ');
    stages.hidden = total === 0;
    stages.setAttribute('aria-label', words);
    stages.title = words;
    while (stages.childElementCount < times.length) stages.append(make('i'));
    [...stages.children].forEach((bar, i) => {
      const share = (times[i]?.milliseconds ?? 0) / (total || 1);
      (bar as HTMLElement).style.flexGrow = String(share);
      (bar as HTMLElement).hidden = share === 0;
    });
    const slowest = times.reduce((most, time) => (time.milliseconds > most.milliseconds ? time : most), { stage: '', milliseconds: 0 });
    setText(took, total > 0 ? `${durationText(total)}, most: ${slowest.stage}` : '');
    took.title = words;
  };
  store.listen((now, before) => {
    update(now);
    if (now.answer !== before.answer) updateTimes(now);
  });
  update(store.now);
  updateTimes(store.now);

  return {
    setFacts(facts) {
      who = whoPlans(facts.status);
      update(store.now);
    },
    setDraws(report) {
      const { shownTriangles: shown = 0, sceneTriangles: all = 0 } = report;
      const of = shown < all ? `; scene simplified to ${shown.toLocaleString('en')} of ${all.toLocaleString('en')}, its proof is not` : '';
      setText(draws, `${counted(report.draws, 'draw')}, ${counted(report.triangles, 'triangle')}${of}`);
    },
  };
}

/** Who plans, by `GET /v1/status`: a daemon with its version and workers, or the process of the door. */
function whoPlans(status: Facts['status']): string {
  if (!status) return '';
  const daemon = (status['daemon'] ?? status) as Record<string, unknown>;
  const version = typeof daemon['version'] === 'string' ? ` ${daemon['version']}` : '';
  if (typeof daemon['workers'] === 'number') return `daemon${version}, ${counted(daemon['workers'], 'worker')}`;
  return 'planned by camway view itself';
}
