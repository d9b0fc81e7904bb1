// SPDX-License-Identifier: MIT
// Puts the parts of the page together, whatever stands behind it.

import type { Answer } from './contract/answer.js';
import type { ExportFormat } from './contract/door.js';
import type { PlanRequest } from './contract/request.js';
import { makeCommands } from './commands.js';
import { PageActions } from './door/page_actions.js';
import type { SceneEditor } from './door/scene_editor.js';
import { Help } from './help.js';
import { listenToKeys } from './keyboard.js';
import { makeLegend } from './legend.js';
import type { Facts, PlanKind } from './model/actions.js';
import { kLeastKeyframes } from './model/edits.js';
import { beginOf, clampToPath } from './model/path.js';
import { pathOf } from './model/stops.js';
import type { Store } from './model/store.js';
import { makePanels } from './panels/panels.js';
import type { Panels } from './panels/panels.js';
import { makeStatusBar } from './panels/status_bar.js';
import type { StatusBar } from './panels/status_bar.js';
import { makeTimeline } from './timeline/timeline.js';
import { switchTheme, watchTheme } from './theme_switch.js';
import { makeIconlessButton, makeTopBar } from './top_bar.js';
import { makeToolbar } from './toolbar.js';
import { Viewport } from './viewport/viewport.js';
import type { Sources, ViewReport } from './viewport/viewport.js';

/** What the door or a review gives to the page. */
export interface Backing {
  sources: Sources;
  request: PlanRequest | undefined;
  facts: Facts;
  plan(request: PlanRequest, kind: PlanKind): void;
  /** Why a request cannot be planned in the scene that is shown, as a sentence; undefined if it can. */
  sceneFault(request: PlanRequest): string | undefined;
  cancelPlan(): void;
  watchPath(request: PlanRequest | undefined): void;
  review(request: PlanRequest, answer: Answer): Promise<Blob>;
  exported(format: ExportFormat, request: PlanRequest, answer: Answer): Promise<Blob>;
  sceneEditor: SceneEditor | undefined;
  /** Begins to fill the store. */
  start(): void;
}

/** What a backing may do with the page. */
export interface PageParts {
  /** With its answer, if there is one: the view is placed by both. */
  load(request: PlanRequest, answer: Answer | undefined): void;
  setFacts(facts: Partial<Facts>): void;
}

function part(name: string): HTMLElement {
  const element = document.querySelector<HTMLElement>(`[data-part="${name}"]`);
  if (!element) throw new Error(`the page has no part ${name}`);
  return element;
}

const kNoRequest: PlanRequest = { keyframes: [] };

export class Page {
  readonly viewport: Viewport;
  report: ViewReport | undefined;
  private facts: Facts;
  private toldDocument = '';
  private isReady = false;
  private readonly actions: PageActions;
  private readonly panels: Panels;
  private readonly statusBar: StatusBar;

  constructor(
    private readonly store: Store,
    open: (parts: PageParts) => Backing,
  ) {
    const backing = open({
      load: (request, answer) => this.actions.load(request, undefined, answer),
      setFacts: (facts) => this.setFacts(facts),
    });
    this.facts = backing.facts;
    this.actions = new PageActions(
      store,
      {
        plan: backing.plan,
        sceneFault: backing.sceneFault,
        cancelPlan: backing.cancelPlan,
        watchPath: backing.watchPath,
        review: backing.review,
        exported: backing.exported,
        sceneEditor: backing.sceneEditor,
        viewPose: () => this.viewport.viewPose,
        viewTarget: () => this.viewport.viewTarget,
        showSelection: () => this.viewport.showSelection(),
        opened: () => this.viewport.showOpened(),
      },
      backing.request ?? kNoRequest,
    );
    this.viewport = new Viewport(part('viewport'), store, this.actions, backing.sources, (report) => this.drawn(report), () => this.finished());
    const commands = makeCommands({
      store,
      actions: this.actions,
      viewport: this.viewport,
      switchTheme,
      toggleHelp: () => help.toggle(),
    });
    const help = new Help(document.body, commands);
    makeToolbar(part('toolbar'), commands, store);
    makeLegend(part('legend'), store);
    makeTopBar(part('bar-tools'), part('message'), part('scene-name'), store, this.actions, [
      makeIconlessButton('Theme', 'Dark or light (T)', switchTheme),
      makeIconlessButton('?', 'Keys (?)', () => help.toggle()),
    ]);
    this.panels = makePanels(part('panels'), store, this.actions);
    this.statusBar = makeStatusBar(part('status'), store, this.actions);
    this.setFacts({});
    makeTimeline(part('timeline'), store, this.actions);
    listenToKeys(commands, store, this.viewport);
    watchTheme(() => this.viewport.applyTheme());
    store.listen((now, before) => {
      if (now.answer !== before.answer || now.before !== before.before) this.keepCursorOnPath();
      this.tellDocument();
    });
    window.addEventListener('beforeunload', (event) => {
      if (store.now.connection !== 'review' && this.actions.document.isDirty) event.preventDefault();
    });
    backing.start();
  }

  private keepCursorOnPath(): void {
    const path = pathOf(this.store.now);
    const { cursor_s } = this.store.now;
    if (path.length === 0) return;
    const inside = clampToPath(path, cursor_s || beginOf(path));
    if (inside !== cursor_s) this.store.set({ cursor_s: inside });
  }

  private setFacts(facts: Partial<Facts>): void {
    this.facts = { ...this.facts, ...facts };
    this.panels?.setFacts(this.facts);
    this.statusBar?.setFacts(this.facts);
  }

  /** Tells the panels of the document, when that changed. */
  private tellDocument(): void {
    const { name, isDirty, canUndo, canRedo } = this.actions.document;
    const told = `${name} ${isDirty} ${canUndo} ${canRedo}`;
    if (told === this.toldDocument) return;
    this.toldDocument = told;
    this.panels.setDocument({ name, isDirty, canUndo, canRedo });
  }

  /** Marks the first picture of the whole scene with its plan, for measurements: tests/bench/run page. */
  private finished(): void {
    const { scene, request, answer, isPending, isDraft } = this.store.now;
    const hasPlan = (request?.keyframes.length ?? 0) < kLeastKeyframes || (answer !== undefined && !isPending && !isDraft);
    const hasScene = scene !== undefined && (this.report?.sceneTriangles ?? 0) >= scene.scene.triangles;
    if (this.isReady || !hasScene || !hasPlan) return;
    this.isReady = true;
    performance.mark('camway-ready');
  }

  private drawn(report: ViewReport): void {
    this.report = report;
    this.statusBar?.setDraws(report);
  }
}
