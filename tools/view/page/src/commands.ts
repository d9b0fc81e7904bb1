// SPDX-License-Identifier: MIT
// All that keys and buttons do, in one table: the keyboard, the tool bar and the help are made from it.

import type { Actions, PlanKind } from './model/actions.js';
import { distanceText, offeredPose } from './model/free_pose.js';
import type { Store } from './model/store.js';
import type { Viewport } from './viewport/viewport.js';

export interface Command {
  /** As `KeyboardEvent.key`, with `Ctrl+` and `Alt+` before it; letters are small. */
  keys: readonly string[];
  /** The keys as people read them; commands without are listed with another one. */
  shown?: string;
  name: string;
  group: 'Keyframes' | 'Time' | 'View' | 'Scene' | 'Files and planning';
  /** `isHeld`: again, as its key is held down. */
  run: (isHeld?: boolean) => void;
  /** Name of the tool bar's picture, for commands that have a button. */
  icon?: string;
  /** Whether the button looks pressed. */
  isOn?: () => boolean;
  /** Whether the command makes sense without editing: in a review and in a read-only page. */
  isViewing?: boolean;
}

export interface CommandContext {
  store: Store;
  actions: Actions;
  viewport: Viewport;
  switchTheme: () => void;
  toggleHelp: () => void;
}

const kNudge_m = 0.05;
const kTurn_deg = 5;

export function selectedKeyframe(store: Store): number | undefined {
  const { selection } = store.now;
  return selection && 'keyframe' in selection ? selection.keyframe : undefined;
}

/** Accepts the free pose that is offered; a far one only where that is allowed. Plans if there is none. */
function acceptOrPlan({ store, actions, viewport }: CommandContext, mayBeFar: boolean): void {
  if (viewport.editing.isDragging) return; // the hand still has the keyframe
  const offered = offeredPose(store.now);
  if (!offered) actions.plan('full');
  else if (!offered.isFar || mayBeFar) actions.acceptFreePose(offered.keyframe);
  else actions.say(`The nearest free pose of keyframe ${offered.keyframe} is ${distanceText(offered)}. Shift Enter accepts it.`);
}

function freeName(store: Store, stem: string): string {
  const names = new Set(store.now.scene?.objects.map(({ name }) => name) ?? []);
  for (let i = 1; ; ++i) if (!names.has(`${stem}_${i}`)) return `${stem}_${i}`;
}

function selectNext(store: Store, actions: Actions, step: number): void {
  const count = store.now.request?.keyframes.length ?? 0;
  if (count === 0) return;
  const selected = selectedKeyframe(store);
  actions.select({ keyframe: selected === undefined ? (step > 0 ? 0 : count - 1) : (selected + step + count) % count });
}

function keyframeCommands(context: CommandContext): Command[] {
  const { store, actions, viewport } = context;
  const kindOf = (isHeld?: boolean): PlanKind => (isHeld ? 'draft' : 'full');
  const nudge = (right: number, up: number, back: number): Command['run'] => (isHeld) => viewport.editing.nudge([right, up, back], kNudge_m, kindOf(isHeld));
  const turn = (yaw: number, pitch: number): Command['run'] => (isHeld) => viewport.editing.turn(yaw * kTurn_deg, pitch * kTurn_deg, kindOf(isHeld));
  const remove = (): void => {
    const { selection } = store.now;
    if (selection && 'keyframe' in selection) actions.deleteKeyframe(selection.keyframe);
    else if (selection) actions.removeObject(selection.object);
  };
  const add = (): void => {
    const isOutside = viewport.isOutside;
    actions.insertKeyframe(undefined, viewport.viewPose);
    if (isOutside) actions.say('This keyframe is outside of the scene. Walk into the scene first (V), or undo (Ctrl Z).');
  };
  const group = 'Keyframes';
  return [
    { keys: ['k'], shown: 'K', name: 'Add a keyframe where the view is', group, icon: 'add', run: add },
    { keys: ['i'], shown: 'I', name: 'Insert a keyframe on the path at the cursor', group, icon: 'insert', run: () => actions.insertKeyframe(store.now.cursor_s) },
    { keys: ['Delete', 'Backspace'], shown: 'Del', name: 'Delete what is selected', group, icon: 'delete', run: remove },
    { keys: ['g'], shown: 'G', name: 'Handles that move', group, icon: 'move', isOn: () => viewport.handleMode === 'translate', run: () => (viewport.handleMode = 'translate') },
    { keys: ['r'], shown: 'R', name: 'Handles that turn', group, icon: 'turn', isOn: () => viewport.handleMode === 'rotate', run: () => (viewport.handleMode = 'rotate') },
    { keys: ['n'], shown: 'N, Shift N', name: 'Select the next or previous keyframe', group, isViewing: true, run: () => selectNext(store, actions, 1) },
    { keys: ['Shift+n'], name: 'Select the previous keyframe', group, isViewing: true, run: () => selectNext(store, actions, -1) },
    { keys: ['Alt+ArrowLeft'], shown: 'Alt ← → ↑ ↓', name: 'Move what is selected level by 5 cm', group, run: nudge(-1, 0, 0) },
    { keys: ['Alt+ArrowRight'], name: 'Move it to the right', group, run: nudge(1, 0, 0) },
    { keys: ['Alt+ArrowUp'], name: 'Move it away', group, run: nudge(0, 0, -1) },
    { keys: ['Alt+ArrowDown'], name: 'Move it nearer', group, run: nudge(0, 0, 1) },
    { keys: ['Alt+PageUp'], shown: 'Alt PgUp PgDn', name: 'Move it up or down', group, run: nudge(0, 1, 0) },
    { keys: ['Alt+PageDown'], name: 'Move it down', group, run: nudge(0, -1, 0) },
    { keys: ['Alt+Shift+ArrowLeft'], shown: 'Alt Shift ← → ↑ ↓', name: 'Turn it by 5°', group, run: turn(1, 0) },
    { keys: ['Alt+Shift+ArrowRight'], name: 'Turn it to the right', group, run: turn(-1, 0) },
    { keys: ['Alt+Shift+ArrowUp'], name: 'Turn it up', group, run: turn(0, 1) },
    { keys: ['Alt+Shift+ArrowDown'], name: 'Turn it down', group, run: turn(0, -1) },
    { keys: ['Enter'], shown: 'Enter', name: 'Accept the near free pose of a keyframe that collides; else plan', group, run: () => acceptOrPlan(context, false) },
    { keys: ['Shift+Enter'], shown: 'Shift Enter', name: 'Accept its free pose, however far it is', group, run: () => acceptOrPlan(context, true) },
  ];
}

function timeCommands({ store, actions }: CommandContext): Command[] {
  const group = 'Time';
  const step = (share: number): void => {
    const segments = store.now.answer?.segments.length ? store.now.answer.segments : store.now.before;
    const duration = (segments[segments.length - 1]?.t1 ?? 0) - (segments[0]?.t0 ?? 0);
    actions.seek(store.now.cursor_s + share * duration);
  };
  const isViewing = true;
  return [
    { keys: [' '], shown: 'Space', name: 'Play or pause', group, isViewing, run: () => (store.now.isPlaying ? actions.pause() : actions.play(1)) },
    { keys: ['ArrowLeft'], shown: '← →', name: 'Back or on by a hundredth of the path', group, isViewing, run: () => step(-0.01) },
    { keys: ['ArrowRight'], name: 'On by a hundredth of the path', group, isViewing, run: () => step(0.01) },
    { keys: ['Home'], shown: 'Home End', name: 'To the begin or the end', group, isViewing, run: () => actions.seek(-Infinity) },
    { keys: ['End'], name: 'To the end', group, isViewing, run: () => actions.seek(Infinity) },
    { keys: ['.'], shown: ', .', name: 'To the previous or next keyframe', group, isViewing, run: () => actions.jump('keyframe', 'next') },
    { keys: [','], name: 'To the previous keyframe', group, isViewing, run: () => actions.jump('keyframe', 'previous') },
    { keys: [']'], shown: '[ ]', name: 'To the previous or next collision', group, isViewing, run: () => actions.jump('collision', 'next') },
    { keys: ['['], name: 'To the previous collision', group, isViewing, run: () => actions.jump('collision', 'previous') },
  ];
}

function viewCommands({ actions, viewport, switchTheme, toggleHelp }: CommandContext): Command[] {
  const group = 'View';
  const isViewing = true;
  const nextCameraMode = { off: 'inset', inset: 'full', full: 'off' } as const;
  return [
    { keys: ['h'], shown: 'H', name: 'Show the path', group, isViewing, icon: 'home', run: () => viewport.home() },
    { keys: ['f'], shown: 'F', name: 'Show what is selected', group, isViewing, icon: 'fit', run: () => actions.showSelection() },
    { keys: ['Shift+h'], shown: 'Shift H', name: 'Show the whole scene', group, isViewing, icon: 'scene', run: () => viewport.showScene() },
    { keys: ['v'], shown: 'V', name: 'Walk, or orbit again', group, isViewing, icon: 'walk', isOn: () => viewport.navigation.mode === 'walk', run: () => viewport.toggleWalk() },
    { keys: ['Shift+v'], shown: 'Shift V', name: 'Walk from where the camera is', group, isViewing, run: () => viewport.walkFromCursor() },
    {
      keys: ['c'],
      shown: 'C',
      name: 'Through the camera: small, full, or not',
      group,
      isViewing,
      icon: 'camera',
      isOn: () => viewport.cameraMode !== 'off',
      run: () => (viewport.cameraMode = nextCameraMode[viewport.cameraMode]),
    },
    { keys: ['m'], shown: 'M', name: 'The other answer, where two are compared', group, isViewing, run: () => actions.showOther() },
    { keys: ['x'], shown: 'X', name: 'Section on or off', group, isViewing, icon: 'section', isOn: () => viewport.section.cutHeight < Infinity, run: () => viewport.toggleSection() },
    { keys: ['0', '1', '2', '3', '4', '5', '6', '7', '8', '9'], shown: '0 … 9', name: 'Open a storey', group, isViewing, run: () => undefined },
    { keys: ['u'], shown: 'U', name: 'Up is Y or Z', group, isViewing, run: () => viewport.setUp(viewport.upAxis === 'y' ? 'z' : 'y') },
    { keys: ['t'], shown: 'T', name: 'Dark or light', group, isViewing, run: switchTheme },
    { keys: ['?'], shown: '?', name: 'These keys', group, isViewing, run: toggleHelp },
  ];
}

function sceneCommands({ store, actions }: CommandContext): Command[] {
  const group = 'Scene';
  return [
    { keys: ['b'], shown: 'B', name: 'Add a box where the view looks', group, icon: 'box', run: () => actions.addObject({ name: freeName(store, 'box'), form: { type: 'box', size: [0.5, 0.5, 0.5] } }) },
    { keys: ['o'], shown: 'O', name: 'Add a ball where the view looks', group, icon: 'ball', run: () => actions.addObject({ name: freeName(store, 'ball'), form: { type: 'sphere', radius_m: 0.3 } }) },
  ];
}

function fileCommands({ actions }: CommandContext): Command[] {
  const group = 'Files and planning';
  return [
    { keys: ['Ctrl+z'], shown: 'Ctrl Z', name: 'Undo', group, run: () => actions.undo() },
    { keys: ['Ctrl+y', 'Ctrl+Shift+z'], shown: 'Ctrl Y', name: 'Redo', group, run: () => actions.redo() },
    { keys: ['Ctrl+o'], shown: 'Ctrl O', name: 'Open a request', group, run: () => actions.open() },
    { keys: ['Ctrl+s'], shown: 'Ctrl S', name: 'Save the request', group, isViewing: true, run: () => actions.save() },
    { keys: ['p'], shown: 'P', name: 'Plan again', group, run: () => actions.plan('full') },
    {
      keys: ['Escape'],
      shown: 'Esc',
      name: 'Cancel planning; select nothing',
      group,
      isViewing: true,
      run: () => {
        actions.cancel();
        actions.select(undefined);
      },
    },
  ];
}

export function makeCommands(context: CommandContext): Command[] {
  return [keyframeCommands, timeCommands, viewCommands, sceneCommands, fileCommands].flatMap((make) => make(context));
}
