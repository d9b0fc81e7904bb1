// SPDX-License-Identifier: MIT
import type { ExportFormat, Field } from '../contract/door.js';
import type { PlanRequest, Quat, Vec3 } from '../contract/request.js';

export interface Pose {
  position: Vec3;
  orientation: Quat;
}

/** What a request is planned for: a frame of a drag, of which the latest counts, or the answer to keep. */
export type PlanKind = 'draft' | 'full';

/** What the time line can jump to. */
export type Stop = 'keyframe' | 'collision';

export type Direction = 'next' | 'previous';

/** A form that the page can make. The door knows more: docs/http.md. */
export type ObjectForm = { type: 'box'; size: Vec3 } | { type: 'sphere'; radius_m: number };

export interface NewObject {
  name: string;
  form: ObjectForm;
  position: Vec3;
  orientation?: Quat;
}

/**
 * All that the page can do, behind one door for mouse, keyboard and panels. An action never throws: what goes
 * wrong is said in `State.message`. Editing actions do nothing in review mode; those that change a scene also do
 * nothing if the page is read only. Keyframes are counted from 0 among the keyframes of the request. An edit is
 * one step of undo, and is planned at once.
 */
export interface Actions {
  // Planning
  plan(kind: PlanKind): void;
  /** Cancels what is being planned. The last answer stays. */
  cancel(): void;
  /** Asks a daemon to watch the path, or to stop. */
  watchPath(isWatched: boolean): void;

  // The request
  undo(): void;
  redo(): void;
  /** Replaces the pose of a keyframe. Drafts (`kind`) of one drag and its end are one step of undo. */
  setKeyframe(index: number, pose: Pose, kind: PlanKind): void;
  /** Sets the time of a keyframe; the keyframes get the times of the path if they had none. */
  setKeyframeTime(index: number, time_s: number): void;
  /**
   * Inserts a keyframe at an instant of the path, with the pose of the path there or with `pose`. Without a time
   * it is appended, with `pose` or the pose of the view. It becomes the selection.
   */
  insertKeyframe(time_s?: number, pose?: Pose): void;
  deleteKeyframe(index: number): void;
  /** Gives all keyframes the times that they have now, or takes all times away. */
  setTimed(isTimed: boolean): void;
  /** Sets an option by the path of its name (`['limits', 'speed_m_per_s']`); `undefined` resets it. */
  setOption(path: readonly string[], value: unknown): void;
  /** Sets members of the camera: `near`, `fov_x_deg`, `fov_y_deg`. */
  setCamera(camera: Partial<NonNullable<PlanRequest['camera']>>): void;
  /** Moves a keyframe that collides to the nearest free pose, which the answer has in `keyframe_faults`. */
  acceptFreePose(keyframe: number): void;
  /** Takes the keyframes and the frame of the answer as those of the request, to edit the path on. */
  editAnswer(): void;

  /** Shows the other one of two answers that are compared, at the same time of the request. Does nothing if there is one alone. */
  showOther(): void;

  /** Shows a sentence until the next one. */
  say(message: string): void;

  // Time
  /** Sets the cursor, within the path. Playing goes on from there. */
  seek(time_s: number): void;
  /** Goes to the next keyframe or collision, or to the previous one. */
  jump(stop: Stop, direction: Direction): void;
  /** Plays at `speed` times the speed of the path, from the beginning if the cursor is at the end. */
  play(speed: number): void;
  pause(): void;

  // The view
  select(selection: { keyframe: number } | { object: string } | undefined): void;
  /** Shows the selected keyframe or object, or else the whole path, in the middle of the view. */
  showSelection(): void;

  // Files
  /** Asks for a request file and opens it, as `openText` does. */
  open(): void;
  /** Opens the text of a request file. A text that is none is refused with a sentence in `State.message`. */
  openText(text: string, name: string): void;
  /** Saves the request as a file. */
  save(): void;
  /** Saves the answer as a file. */
  saveAnswer(): void;
  exportAs(format: ExportFormat): void;
  /** Saves one self-contained HTML file that shows the request and its answer. */
  saveReview(): void;

  // The scene
  moveObject(name: string, pose: Pose): void;
  /** Adds an object; without a position at the point that the view looks at. */
  addObject(object: Omit<NewObject, 'position'> & { position?: Vec3 }): void;
  removeObject(name: string): void;
}

/** What the door says once; the panels are told again when it is known or changes. */
export interface Facts {
  /** `GET /v1/fields`; empty in review mode. */
  readonly fields: readonly Field[];
  /** The formats that the door exports; empty if it exports none. */
  readonly exports: readonly ExportFormat[];
  /** `backend` of `GET /v1/status`. */
  readonly status: Readonly<Record<string, unknown>> | undefined;
}

/** The request as a document: `RequestDocument` has these. */
export interface DocumentFacts {
  readonly name: string;
  readonly isDirty: boolean;
  readonly canUndo: boolean;
  readonly canRedo: boolean;
}

/** What the viewport drew last, for the status bar. */
export interface DrawReport {
  readonly draws: number;
  /** Of all parts of the picture together; a scene that is drawn three times counts three times. */
  readonly triangles: number;
  /** Triangles of the scene as it is drawn, and as it is; fewer where the picture is simplified. */
  readonly shownTriangles?: number;
  readonly sceneTriangles?: number;
}
