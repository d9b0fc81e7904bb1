// SPDX-License-Identifier: MIT
// The actions of the page: edits of the document, questions to the door, and the cursor's time.

import type { ExportFormat } from '../contract/door.js';
import type { Vec3, PlanRequest } from '../contract/request.js';
import type { Actions, Direction, NewObject, PlanKind, Pose, Stop } from '../model/actions.js';
import { RequestDocument } from '../model/document.js';
import {
  insertedAfter,
  insertedAtCursor,
  isRefusal,
  withAnswer,
  withCamera,
  withOption,
  withoutKeyframe,
  withoutTimes,
  withPose,
  withTime,
  withTimes,
} from '../model/edits.js';
import type { Insertion, Refusal } from '../model/edits.js';
import { withOtherAnswer } from '../model/beside.js';
import { beginOf, clampToPath, endOf } from '../model/path.js';
import { answerText, readRequest, requestText } from '../model/request_file.js';
import { nextStop, pathOf } from '../model/stops.js';
import { isAnswered } from '../model/store.js';
import type { State, Store } from '../model/store.js';
import { pickFile, saveFile } from './files.js';
import type { SceneEditor } from './scene_editor.js';

/** What the actions need of the rest of the page. */
export interface Surroundings {
  plan(request: PlanRequest, kind: PlanKind): void;
  /** Why a request cannot be planned in the scene that is shown, as a sentence; undefined if it can. */
  sceneFault(request: PlanRequest): string | undefined;
  cancelPlan(): void;
  watchPath(request: PlanRequest | undefined): void;
  review(request: PlanRequest, answer: NonNullable<State['answer']>): Promise<Blob>;
  exported(format: ExportFormat, request: PlanRequest, answer: NonNullable<State['answer']>): Promise<Blob>;
  readonly sceneEditor: SceneEditor | undefined;
  viewPose(): Pose;
  viewTarget(): Vec3;
  showSelection(): void;
  /** A request was opened: shows its path. */
  opened(): void;
}

const kDragName = 'keyframe';
const kNewName = 'request.json';

export class PageActions implements Actions {
  private documentNow: RequestDocument;
  private playSpeed = 0;
  private playedAt_ms = 0;

  constructor(
    private readonly store: Store,
    private readonly around: Surroundings,
    request: PlanRequest,
  ) {
    this.documentNow = new RequestDocument(request, kNewName);
  }

  get document(): RequestDocument {
    return this.documentNow;
  }

  private get canEdit(): boolean {
    return this.store.now.connection !== 'review';
  }

  say(message: string): void {
    this.store.set({ message });
  }

  /** Shows the document's request, and plans it. */
  private edited(kind: PlanKind = 'full', selection = this.store.now.selection): void {
    const request = this.document.current;
    const kept = selection && 'keyframe' in selection && selection.keyframe >= request.keyframes.length ? undefined : selection;
    this.store.set({ request, selection: kept });
    this.around.plan(request, kind);
    if (kind === 'full' && this.store.now.watched !== 'off') this.around.watchPath(request);
  }

  private apply(next: PlanRequest | Refusal): boolean {
    if (!this.canEdit) return false;
    if (isRefusal(next as PlanRequest | Refusal)) {
      this.say((next as Refusal).refused);
      return false;
    }
    if (!this.document.apply(next as PlanRequest)) return false;
    this.edited();
    return true;
  }

  plan(kind: PlanKind): void {
    if (this.canEdit) this.around.plan(this.document.current, kind);
  }

  cancel(): void {
    this.around.cancelPlan();
  }

  watchPath(isWatched: boolean): void {
    if (this.canEdit) this.around.watchPath(isWatched ? this.document.current : undefined);
  }

  undo(): void {
    if (this.canEdit && this.document.undo()) this.edited();
  }

  redo(): void {
    if (this.canEdit && this.document.redo()) this.edited();
  }

  setKeyframe(index: number, pose: Pose, kind: PlanKind): void {
    if (!this.canEdit) return;
    this.document.apply(withPose(this.document.current, index, pose), kDragName);
    if (kind === 'full') this.document.endDrag();
    this.edited(kind);
  }

  setKeyframeTime(index: number, time_s: number): void {
    this.apply(withTime(this.document.current, index, time_s));
  }

  insertKeyframe(time_s?: number, pose?: Pose): void {
    if (!this.canEdit) return;
    const request = this.document.current;
    const inserted: Insertion | Refusal =
      time_s === undefined
        ? insertedAfter(request, request.keyframes.length - 1, pose ?? this.around.viewPose())
        : insertedAtCursor(request, this.store.now, time_s, pose);
    if ('refused' in inserted) {
      this.say(inserted.refused);
      return;
    }
    this.document.apply(inserted.request);
    this.edited('full', { keyframe: inserted.index });
    if (inserted.request.keyframes.length === 1) this.say('One keyframe. Go on to the next place, and press K again.');
  }

  deleteKeyframe(index: number): void {
    this.apply(withoutKeyframe(this.document.current, index));
  }

  setTimed(isTimed: boolean): void {
    this.apply(isTimed ? withTimes(this.document.current) : withoutTimes(this.document.current));
  }

  setOption(path: readonly string[], value: unknown): void {
    this.apply(withOption(this.document.current, path, value));
  }

  setCamera(camera: Partial<NonNullable<PlanRequest['camera']>>): void {
    this.apply(withCamera(this.document.current, camera));
  }

  acceptFreePose(keyframe: number): void {
    const fault = this.store.now.answer?.keyframe_faults?.find((candidate) => candidate.keyframe === keyframe);
    if (!fault?.free_pose) this.say(`No free pose was found near keyframe ${keyframe}.`);
    else this.apply(withPose(this.document.current, keyframe, fault.free_pose));
  }

  editAnswer(): void {
    const { answer } = this.store.now;
    if (answer && isAnswered(this.store.now) && answer.keyframes.length > 0) this.apply(withAnswer(this.document.current, answer));
  }

  seek(time_s: number): void {
    this.store.set({ cursor_s: clampToPath(pathOf(this.store.now), time_s) });
  }

  jump(stop: Stop, direction: Direction): void {
    const time_s = nextStop(this.store.now, stop, direction);
    if (time_s !== undefined) this.seek(time_s);
  }

  play(speed: number): void {
    const path = pathOf(this.store.now);
    if (path.length === 0) return;
    if (this.store.now.cursor_s >= endOf(path)) this.seek(beginOf(path));
    const isRunning = this.store.now.isPlaying;
    this.playSpeed = speed;
    this.playedAt_ms = performance.now();
    this.store.set({ isPlaying: true });
    if (!isRunning) requestAnimationFrame((now_ms) => this.playOn(now_ms));
  }

  private playOn(now_ms: number): void {
    if (!this.store.now.isPlaying) return;
    const path = pathOf(this.store.now);
    const elapsed_s = Math.max(0, now_ms - this.playedAt_ms) / 1000;
    this.playedAt_ms = now_ms;
    const cursor_s = clampToPath(path, this.store.now.cursor_s + this.playSpeed * elapsed_s);
    const isAtEnd = cursor_s >= endOf(path);
    this.store.set({ cursor_s, isPlaying: !isAtEnd });
    if (!isAtEnd) requestAnimationFrame((next_ms) => this.playOn(next_ms));
  }

  pause(): void {
    if (this.store.now.isPlaying) this.store.set({ isPlaying: false });
  }

  select(selection: State['selection']): void {
    this.store.set({ selection });
  }

  showSelection(): void {
    this.around.showSelection();
  }

  open(): void {
    if (this.canEdit) void pickFile('.json,application/json').then(({ name, text }) => this.openText(text, name));
  }

  openText(text: string, name: string): void {
    if (!this.canEdit) return;
    const read = readRequest(text);
    if ('error' in read) {
      this.say(`${name}: ${read.error}`);
      return;
    }
    const fault = this.around.sceneFault(read.request);
    if (fault) {
      this.say(`${name} was not opened. ${fault}`);
      return;
    }
    this.load(read.request, name);
    this.around.plan(read.request, 'full');
  }

  /** Makes a request the document's, without planning it: one step of undo, unless there was nothing before. */
  load(request: PlanRequest, name = kNewName, answer?: State['answer']): void {
    const isFirst = this.document.current.keyframes.length === 0 && !this.document.canUndo;
    if (isFirst) this.documentNow = new RequestDocument(request, name);
    this.document.apply(request);
    this.document.name = name;
    this.document.markSaved();
    this.store.set({ request, selection: undefined, cursor_s: 0, answer, unplanned: '', before: [], message: '' });
    this.around.opened();
  }

  showOther(): void {
    const exchanged = withOtherAnswer(this.store.now);
    if (exchanged) this.store.set({ ...exchanged, message: '' });
  }

  save(): void {
    saveFile(this.document.name, requestText(this.document.current));
    this.document.markSaved();
  }

  saveAnswer(): void {
    const { answer } = this.store.now;
    if (answer && isAnswered(this.store.now)) saveFile(`${this.baseName}-answer.json`, answerText(answer));
  }

  private get baseName(): string {
    return this.document.name.replace(/\.json$/, '');
  }

  exportAs(format: ExportFormat): void {
    const { answer, request } = this.store.now;
    if (!answer || !request || !isAnswered(this.store.now)) return;
    this.around.exported(format, request, answer).then(
      (file) => saveFile(`${this.baseName}${format.extension}`, file),
      (error: Error) => this.say(error.message),
    );
  }

  saveReview(): void {
    const { answer, request } = this.store.now;
    if (!answer || !request || !isAnswered(this.store.now)) return;
    this.around.review(request, answer).then(
      (file) => saveFile(`${this.baseName}.html`, file),
      (error: Error) => this.say(error.message),
    );
  }

  private get canChangeScene(): boolean {
    return this.canEdit && !this.store.now.isReadOnly;
  }

  moveObject(name: string, pose: Pose): void {
    if (this.canChangeScene) this.around.sceneEditor?.move(name, pose);
  }

  addObject(object: Omit<NewObject, 'position'> & { position?: Vec3 }): void {
    if (!this.canChangeScene) return;
    this.around.sceneEditor?.add({ ...object, position: object.position ?? this.around.viewTarget() });
    this.select({ object: object.name });
  }

  removeObject(name: string): void {
    if (!this.canChangeScene) return;
    this.around.sceneEditor?.remove(name);
    const { selection } = this.store.now;
    if (selection && 'object' in selection && selection.object === name) this.select(undefined);
  }
}
