// SPDX-License-Identifier: MIT
// The view of request and answer: the path, keyframes, findings, the body at the cursor, and names.

import { Group, Vector3 } from 'three';
import type { IUniform, Vector4 } from 'three';
import type { State } from '../model/store.js';
import type { Pose } from '../model/actions.js';
import { besideOf } from '../model/beside.js';
import { acceptingKey, distanceText, offeredPose } from '../model/free_pose.js';
import { poseAt } from '../model/path.js';
import { pathOf } from '../model/stops.js';
import { kDefaultCamera } from './bodies.js';
import type { CameraViews, Eye } from './camera_views.js';
import { CursorView } from './cursor_view.js';
import type { Extent } from './extent.js';
import { FindingsView } from './findings_view.js';
import type { TriangleSource } from './findings_view.js';
import { toQuaternion } from './frame.js';
import type { Frame } from './frame.js';
import { KeyframesView } from './keyframes_view.js';
import type { Label } from './labels.js';
import { PathView } from './path_view.js';
import type { Theme } from './theme.js';
import type { TubeUniforms } from './tubes.js';

/** Names beyond that many are not even tried. */
const kMostLabels = 2000;

/** Where the object that was clicked was hit. */
export interface Picked {
  name: string;
  point: Vector3;
  /** The part of the object there, where its file has names; undefined until it is known. */
  part: string | undefined;
}

export class Content {
  readonly group = new Group();
  private readonly pathView: PathView;
  private readonly keyframesView: KeyframesView;
  private readonly cursorView: CursorView;
  private readonly findings: FindingsView;

  constructor(tubes: TubeUniforms, section: IUniform<Vector4>, private readonly extent: Extent, onChange: () => void) {
    this.pathView = new PathView(tubes);
    this.keyframesView = new KeyframesView(tubes);
    this.cursorView = new CursorView(tubes);
    this.findings = new FindingsView(tubes, section, onChange);
    this.group.add(this.pathView.group, this.keyframesView.group, this.cursorView.group, this.findings.group);
  }

  /** Places of the keyframes of the request. */
  get places(): readonly Vector3[] {
    return this.keyframesView.places;
  }

  /** Whether nothing of the findings is on its way. */
  get isComplete(): boolean {
    return this.findings.isComplete;
  }

  showPath(now: State, frame: Frame, theme: Theme, pixelRatio: number): void {
    const { request, answer, selection } = now;
    const selected = selection && 'keyframe' in selection ? selection.keyframe : undefined;
    this.pathView.show(answer, besideOf(now), frame, { unproved: theme.ink });
    this.keyframesView.show(
      { request, answer, selected, frame, pathSize_m: this.extent.pathSize_m },
      { given: theme.ink, selected: theme.accent, rim: theme.rim, pixelRatio },
    );
    this.findings.setLook([...theme.rim], pixelRatio);
  }

  showFindings({ answer, isDraft }: State, frame: Frame, source: TriangleSource): void {
    void this.findings.show(answer, frame, isDraft ? undefined : source);
  }

  showCursor(now: State, frame: Frame, theme: Theme, cameraViews: CameraViews): void {
    const { answer, request, cursor_s, compared } = now;
    const pose = poseAt(pathOf(now), cursor_s);
    const beside = besideOf(now);
    const beside_s = beside.timeOf(cursor_s);
    const poseBefore = answer?.segments.length ? poseAt(beside.path, beside_s) : undefined;
    const nearScale = answer?.near_scale ?? 1;
    const camera = { ...(request?.camera ?? kDefaultCamera) };
    this.cursorView.show(request, pose, poseBefore, frame, this.extent.pathSize_m, theme.accent, nearScale);
    const eye = (at: Pose | undefined, isColliding: boolean): Eye | undefined =>
      at && { position: frame.toLocal(at.position), orientation: toQuaternion(at.orientation), isColliding };
    const collides = (answer?.remaining_collisions ?? []).some(({ t_begin, t_end }) => cursor_s >= t_begin && cursor_s <= t_end);
    const collidesBeside = beside.collisions.some(({ begin, end }) => beside_s >= begin && beside_s <= end);
    const isCorrected = (answer?.corrections ?? []).some(({ kind }) => kind !== 'none');
    cameraViews.setPath(answer?.segments.length ? 'after' : 'before', compared);
    cameraViews.setEyes(
      { ...camera, near: camera.near * nearScale },
      eye(pose, collides),
      isCorrected || compared ? eye(poseBefore, collidesBeside) : undefined,
      4 * this.extent.sceneSphere.radius,
    );
  }

  /** Names for what is shown. The selected one comes first: numbers give way to those before them. */
  labels({ request, answer, selection, scene, connection }: State, picked: Picked | undefined): Label[] {
    const selected = selection && 'keyframe' in selection ? selection.keyframe : undefined;
    const faults = new Set((answer?.keyframe_faults ?? []).map(({ keyframe }) => keyframe));
    const proof = answer?.infeasibility;
    const isEditable = connection !== 'review';
    const suffix = (i: number): string =>
      proof?.keyframe_inside === i ? ' inside' : proof?.keyframe_outside === i ? ' outside' : faults.has(i) ? ' collides' : '';
    const labels = this.places.slice(0, kMostLabels).map(
      (at, i): Label => ({
        text: `${i}${suffix(i)}`,
        at,
        kind: faults.has(i) ? 'invalid' : i === selected ? 'selected' : 'keyframe',
      }),
    );
    const offered = offeredPose({ request, answer, selection });
    if (offered && isEditable) {
      const at = this.extent.placeOf(offered.pose.position);
      labels.unshift({ text: `free, ${distanceText(offered)}: ${acceptingKey(offered)}`, at, kind: 'free' });
    }
    if (selection && 'object' in selection) {
      const bounds = scene?.objects.find(({ name }) => name === selection.object)?.bounds;
      const at = picked?.point ?? (bounds && this.extent.boxOf(bounds).getCenter(new Vector3()));
      const part = picked?.part === undefined ? '' : `: ${picked.part}`;
      if (at) labels.unshift({ text: `${selection.object}${part}`, at, kind: 'object' });
    }
    return labels.sort((a, b) => Number(a.kind === 'keyframe') - Number(b.kind === 'keyframe'));
  }
}
