// SPDX-License-Identifier: MIT
//
// The row above the time line: play, jumps, the time, and which curves are drawn.

import type { Actions } from '../model/actions.js';
import type { CurveName } from '../model/curves.js';
import { kCurveKinds } from '../model/curves.js';
import { positionText, timeText, withUnit } from '../model/format.js';
import { beginOf, durationOf, endOf } from '../model/path.js';
import { collisionTimes, pathOf } from '../model/stops.js';
import type { State, Store } from '../model/store.js';
import { make, makeIconButton, setText } from '../panels/dom.js';

const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 4] as const;

export interface Transport {
  element: HTMLElement;
  shown(): readonly CurveName[];
}

export function makeTransport(store: Store, actions: Actions, curvesChanged: () => void): Transport {
  const speed = make('select', { 'aria-label': 'Speed of playing', title: 'Speed of playing' });
  for (const factor of kSpeeds) speed.append(new Option(`${factor}×`, String(factor), factor === 1, factor === 1));
  const play = makeIconButton('▶', 'Play', () => {
    if (store.now.isPlaying) actions.pause();
    else actions.play(Number(speed.value));
  });
  speed.addEventListener('change', () => {
    if (store.now.isPlaying) actions.play(Number(speed.value));
  });
  const jumps = [
    makeIconButton('◂●', 'Previous keyframe', () => actions.jump('keyframe', 'previous')),
    makeIconButton('●▸', 'Next keyframe', () => actions.jump('keyframe', 'next')),
    makeIconButton('◂✕', 'Previous collision', () => actions.jump('collision', 'previous')),
    makeIconButton('✕▸', 'Next collision', () => actions.jump('collision', 'next')),
  ] as const;
  const time = make('output', { class: 'cw-time', 'aria-live': 'off' });
  const shown = new Set<CurveName>(['speed', 'clearance']);
  const curves = make('fieldset', { class: 'cw-curves' }, make('legend', { text: 'Curves' }));
  for (const kind of kCurveKinds) curves.append(curveBox(kind.name, kind.label, kind.help, shown, curvesChanged));

  const update = (now: State): void => {
    const path = pathOf(now);
    const hasPath = path.length > 0;
    setText(play, now.isPlaying ? '❚❚' : '▶');
    play.title = now.isPlaying ? 'Pause' : 'Play';
    play.setAttribute('aria-label', play.title);
    play.disabled = !hasPath;
    const hasCollisions = collisionTimes(now.answer).length > 0;
    jumps.forEach((button, i) => (button.disabled = !hasPath || (i >= 2 && !hasCollisions)));
    setText(time, hasPath ? positionText(now.cursor_s, beginOf(path), endOf(path)) : 'no path');
    time.title = hasPath ? `From ${timeText(beginOf(path), beginOf(path))} s on, ${withUnit(durationOf(path), 's')} long` : '';
  };
  store.listen(update);
  update(store.now);

  return {
    element: make('div', { class: 'cw-transport', role: 'group', 'aria-label': 'Playing' }, play, speed, ...jumps, time, curves),
    shown: () => kCurveKinds.map((kind) => kind.name).filter((name) => shown.has(name)),
  };
}

function curveBox(name: CurveName, text: string, help: string, shown: Set<CurveName>, changed: () => void): HTMLElement {
  const box = make('input', { type: 'checkbox' });
  box.checked = shown.has(name);
  box.addEventListener('change', () => {
    if (box.checked) shown.add(name);
    else shown.delete(name);
    changed();
  });
  return make('label', { class: 'cw-check', title: help }, box, text);
}
