// SPDX-License-Identifier: MIT
import type { Actions } from '../model/actions.js';
import { Curves, kCurveKinds, kShiftByPlace } from '../model/curves.js';
import { timeText } from '../model/format.js';
import { beginOf, endOf } from '../model/path.js';
import { pathOf } from '../model/stops.js';
import type { State, Store } from '../model/store.js';
import { make, oncePerFrame } from '../panels/dom.js';
import type { BandRow, Mark } from './bands.js';
import { bandRows, marksOf } from './bands.js';
import type { Layout } from './layout.js';
import { kMarksHeight, layoutOf, timeAtX, xOf } from './layout.js';
import type { Lane } from './paint.js';
import { paint, paintCursor } from './paint.js';
import type { Theme } from './theme.js';
import { themeOf, watchTheme } from './theme.js';
import { makeTransport } from './transport.js';
import { linesAt } from './values.js';

/** A press this near to a mark takes the keyframe. */
const kMarkReach = 7;

/** Steps of the arrow keys, as shares of the path; with Shift and by page keys they are larger. */
const kSmallStep = 1 / 200;
const kLargeStep = 1 / 20;

const kMissing: Readonly<Record<string, string>> = {
  clearance: 'no profile of the clearance in this answer',
  shift: 'no path before to compare with',
};

/** What the time line shows, made anew when request, answer or path change. */
interface Content {
  curves: Curves;
  rows: BandRow[];
  marks: Mark[];
}

/** Makes the time line in `host`: playing, curves and bands over time, and a cursor to scrub with. */
export function makeTimeline(host: HTMLElement, store: Store, actions: Actions): void {
  new Timeline(host, store, actions);
}

class Timeline {
  private readonly base = make('canvas', { 'aria-hidden': 'true' });
  private readonly overlay = make('canvas', { 'aria-hidden': 'true' });
  private readonly tooltip = make('div', { class: 'cw-tooltip', role: 'tooltip', hidden: '' });
  private readonly slider: HTMLElement;
  private readonly transport;
  private readonly askFullPaint = oncePerFrame(() => this.paintAll());
  private readonly askCursorPaint = oncePerFrame(() => this.paintCursor());
  private content: Content;
  private theme: Theme;
  private layout: Layout;
  private hover_s: number | undefined;
  private isScrubbing = false;

  constructor(
    private readonly host: HTMLElement,
    private readonly store: Store,
    private readonly actions: Actions,
  ) {
    this.transport = makeTransport(store, actions, () => this.askFullPaint());
    this.slider = make('div', { class: 'cw-slider', role: 'slider', tabindex: '0', 'aria-label': 'Time on the path' });
    this.slider.append(this.base, this.overlay, this.tooltip);
    host.classList.add('cw-timeline');
    host.append(this.transport.element, this.slider);
    this.content = contentOf(store.now);
    this.theme = themeOf(host);
    this.layout = layoutOf(0, 0, 0, 0, 0);
    this.listen();
    this.paintAll();
  }

  private listen(): void {
    this.store.listen((now, before) => this.update(now, before));
    new ResizeObserver(() => this.askFullPaint()).observe(this.slider);
    watchTheme(() => this.askFullPaint());
    this.watchPixelRatio();
    this.slider.addEventListener('pointerdown', (event) => this.press(event));
    this.slider.addEventListener('pointermove', (event) => this.move(event));
    this.slider.addEventListener('pointerup', () => (this.isScrubbing = false));
    this.slider.addEventListener('pointercancel', () => (this.isScrubbing = false));
    this.slider.addEventListener('pointerleave', () => this.showHover(undefined));
    this.slider.addEventListener('keydown', (event) => this.key(event));
  }

  /** Moving to another screen changes the ratio without changing the size. */
  private watchPixelRatio(): void {
    const query = matchMedia(`(resolution: ${devicePixelRatio}dppx)`);
    query.addEventListener('change', () => { this.watchPixelRatio(); this.askFullPaint(); }, { once: true });
  }

  private update(now: State, before: State): void {
    const isNew = now.answer !== before.answer || now.before !== before.before || now.request !== before.request;
    if (isNew) this.content = contentOf(now);
    if (isNew || now.selection !== before.selection) this.askFullPaint();
    else if (now.cursor_s !== before.cursor_s) this.askCursorPaint();
  }

  private paintAll(): void {
    const path = pathOf(this.store.now);
    const lanes = this.lanes();
    this.theme = themeOf(this.host);
    this.layout = layoutOf(this.slider.clientWidth, beginOf(path), endOf(path), this.content.rows.length, lanes.length);
    this.slider.style.height = `${this.layout.height}px`;
    const context = sized(this.base, this.layout);
    const { selection } = this.store.now;
    const selectedKeyframe = selection && 'keyframe' in selection ? selection.keyframe : undefined;
    if (context && this.layout.width > 0) {
      const { rows, marks } = this.content;
      paint(context, { layout: this.layout, rows, marks, lanes, selectedKeyframe, theme: this.theme });
    }
    sized(this.overlay, this.layout);
    this.paintCursor();
  }

  private paintCursor(): void {
    const context = this.overlay.getContext('2d');
    const now = this.store.now;
    if (context && pathOf(now).length > 0) paintCursor(context, this.layout, this.theme, now.cursor_s, this.hover_s);
    this.describe(now);
  }

  private lanes(): Lane[] {
    return this.transport.shown().flatMap((name) => {
      const isByPlace = name === 'shift' && !this.content.curves.times.isSame;
      const kind = isByPlace ? kShiftByPlace : kCurveKinds.find((known) => known.name === name);
      return kind ? [{ kind, curve: this.content.curves.curve(name), missing: this.missing(name) }] : [];
    });
  }

  private missing(name: string): string {
    if (pathOf(this.store.now).length === 0) return '';
    return kMissing[name] ?? '';
  }

  private describe(now: State): void {
    const { t0, t1 } = this.layout;
    const lines = this.linesAt(now.cursor_s);
    this.slider.setAttribute('aria-valuemin', String(t0));
    this.slider.setAttribute('aria-valuemax', String(t1));
    this.slider.setAttribute('aria-valuenow', String(now.cursor_s));
    this.slider.setAttribute('aria-valuetext', `${lines.join(', ')}; of ${timeText(t1, t0)} s`);
    this.slider.setAttribute('aria-disabled', String(!(t1 > t0)));
  }

  private linesAt(time_s: number): string[] {
    const curves = this.lanes().flatMap((lane) => (lane.curve ? [lane.curve] : []));
    return linesAt({ ...this.content, layout: this.layout, curves }, time_s);
  }

  private timeOf(event: PointerEvent): number {
    return timeAtX(this.layout, event.clientX - this.slider.getBoundingClientRect().left);
  }

  private press(event: PointerEvent): void {
    if (event.button !== 0 || pathOf(this.store.now).length === 0) return;
    const mark = this.markAt(event);
    if (mark?.index !== undefined) this.actions.select({ keyframe: mark.index });
    if (mark) {
      this.actions.seek(mark.time_s);
      return;
    }
    this.isScrubbing = true;
    this.slider.setPointerCapture(event.pointerId);
    this.actions.seek(this.timeOf(event));
  }

  private move(event: PointerEvent): void {
    const time_s = this.timeOf(event);
    if (this.isScrubbing) this.actions.seek(time_s);
    this.showHover(event.pointerType === 'touch' && !this.isScrubbing ? undefined : (this.markAt(event)?.time_s ?? time_s));
  }

  /** The mark under the pointer; of several the one that is drawn on top. */
  private markAt(event: PointerEvent): Mark | undefined {
    const box = this.slider.getBoundingClientRect();
    const y = event.clientY - box.top - this.layout.marksTop;
    if (y < 0 || y > kMarksHeight) return undefined;
    const x = event.clientX - box.left;
    return this.content.marks.filter((mark) => Math.abs(xOf(this.layout, mark.time_s) - x) <= kMarkReach).at(-1);
  }

  private showHover(time_s: number | undefined): void {
    const hasPath = pathOf(this.store.now).length > 0;
    this.hover_s = hasPath ? time_s : undefined;
    this.askCursorPaint();
    this.tooltip.hidden = this.hover_s === undefined;
    if (this.hover_s === undefined) return;
    this.tooltip.replaceChildren(...this.linesAt(this.hover_s).map((text) => make('div', { text })));
    const x = xOf(this.layout, this.hover_s);
    const width = this.tooltip.offsetWidth;
    const isRight = x + 14 + width > this.layout.width;
    // In the window and not in the strip, which scrolls where the window is low, and would cut it off.
    const slider = this.slider.getBoundingClientRect();
    const top = Math.max(slider.top, this.host.getBoundingClientRect().top);
    this.tooltip.style.left = `${slider.left + Math.max(0, isRight ? x - 14 - width : x + 14)}px`;
    this.tooltip.style.bottom = `${innerHeight - top}px`;
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { t0, t1 } = this.layout;
    const now_s = this.store.now.cursor_s;
    const step_s = (event.shiftKey ? kLargeStep : kSmallStep) * (t1 - t0);
    const page_s = kLargeStep * (t1 - t0);
    const keys: Record<string, () => void> = {
      ArrowLeft: () => this.actions.seek(now_s - step_s),
      ArrowDown: () => this.actions.seek(now_s - step_s),
      ArrowRight: () => this.actions.seek(now_s + step_s),
      ArrowUp: () => this.actions.seek(now_s + step_s),
      PageUp: () => this.actions.seek(now_s + page_s),
      PageDown: () => this.actions.seek(now_s - page_s),
      Home: () => this.actions.seek(t0),
      End: () => this.actions.seek(t1),
    };
    const act = keys[event.key];
    if (!act) return;
    event.preventDefault();
    event.stopPropagation();
    act();
  }
}

function contentOf(state: State): Content {
  const path = pathOf(state);
  const hasAnswer = state.answer !== undefined;
  return {
    curves: new Curves(path, hasAnswer ? state.before : [], state.request, state.answer),
    rows: bandRows(state.answer),
    marks: path.length > 0 ? marksOf(state) : [],
  };
}

/** The context of a canvas with a pixel for each pixel of the screen, whose unit is a CSS pixel. */
function sized(canvas: HTMLCanvasElement, layout: Layout): CanvasRenderingContext2D | null {
  const ratio = devicePixelRatio;
  const width = Math.round(layout.width * ratio);
  const height = Math.round(layout.height * ratio);
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
    canvas.style.width = `${layout.width}px`;
    canvas.style.height = `${layout.height}px`;
  }
  const context = canvas.getContext('2d');
  context?.setTransform(ratio, 0, 0, ratio, 0, 0);
  return context;
}
