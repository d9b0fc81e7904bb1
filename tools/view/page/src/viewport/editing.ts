// SPDX-License-Identifier: MIT
// Edits by hand in the view: keyframes and objects that are moved and turned become actions.

import { Quaternion, Vector3 } from 'three';
import type { Vec3 } from '../contract/request.js';
import type { Actions, PlanKind, Pose } from '../model/actions.js';
import type { Store } from '../model/store.js';
import type { Extent } from './extent.js';
import { toQuaternion, upVector } from './frame.js';
import type { Frame, UpAxis } from './frame.js';
import { Handles } from './handles.js';
import type { HandleTarget } from './handles.js';
import type { Navigation } from './navigation.js';
import { Pointer } from './pointer.js';
import type { Hit, SceneView } from './scene_view.js';
import type { Stage } from './stage.js';

/** Objects that are a larger part of the scene are the building, and are not dragged by accident. */
const kLargestMovable = 0.4;
const kSurfaceMargin_m = 0.05;

export interface EditingContext {
  readonly store: Store;
  readonly actions: Actions;
  readonly stage: Stage;
  readonly navigation: Navigation;
  readonly sceneView: SceneView;
  readonly extent: Extent;
  frame(): Frame;
  up(): UpAxis;
  places(): readonly Vector3[];
  /** Whether the mouse is over something that is no view of the scene to edit. */
  isCovered(): boolean;
  onPicked(hit: Hit | undefined): void;
}

type LocalPose = Pick<HandleTarget, 'position' | 'orientation'>;

export class Editing {
  readonly handles: Handles;
  private readonly pointer: Pointer;
  private dragged: Pose | undefined;
  /** The keyframe that a key moves which is held down. */
  private held: HandleTarget | undefined;

  constructor(private readonly context: EditingContext) {
    const { stage, navigation } = context;
    this.handles = new Handles(navigation.camera, stage.canvas, stage.scene, {
      onDrag: (position, orientation) => this.dragHandle(position, orientation, 'draft'),
      onRelease: (position, orientation) => this.dragHandle(position, orientation, 'full'),
      onBusy: (isBusy) => (navigation.controls.enabled = !isBusy),
      onChange: () => stage.invalidate(),
    });
    this.pointer = this.makePointer();
  }

  get isDragging(): boolean {
    return this.pointer.isDragging;
  }

  private get canEdit(): boolean {
    return this.context.store.now.connection !== 'review';
  }

  /** Puts the handles where the selection is. */
  update(): void {
    this.handles.show(this.target());
    this.handles.visible = !this.pointer.isDragging;
  }

  private target(): HandleTarget | undefined {
    const { store, extent } = this.context;
    const { selection, request, isReadOnly, scene, moves } = store.now;
    const frame = this.context.frame();
    if (!selection || !this.canEdit) return undefined;
    if ('keyframe' in selection) {
      const keyframe = request?.keyframes[selection.keyframe];
      if (!keyframe) return undefined;
      const position = frame.toLocal(keyframe.position);
      return { key: `keyframe ${selection.keyframe}`, position, orientation: toQuaternion(keyframe.orientation) };
    }
    const facts = scene?.objects.find(({ name }) => name === selection.object);
    if (!facts || isReadOnly) return undefined;
    const share = extent.boxOf(facts.bounds).getSize(new Vector3()).length() / (2 * extent.sceneSphere.radius);
    if (share > kLargestMovable) return undefined;
    // Keys come faster than the scene answers: each goes on from the pose that the one before asked for.
    const { position, orientation } = moves.get(facts.name) ?? facts;
    return { key: `object ${facts.name}`, position: frame.toLocal(position), orientation: toQuaternion(orientation) };
  }

  private dragHandle(position: Vector3, orientation: Quaternion, kind: PlanKind): void {
    const { store, actions } = this.context;
    const { selection } = store.now;
    const pose = this.context.frame().toPose(position, orientation);
    if (!selection) return;
    if ('keyframe' in selection) actions.setKeyframe(selection.keyframe, pose, kind);
    else actions.moveObject(selection.object, pose);
  }

  private makePointer(): Pointer {
    const { stage, navigation, actions, sceneView } = this.context;
    return new Pointer({
      element: stage.canvas,
      camera: navigation.camera,
      up: () => upVector(this.context.up()),
      canDrag: () => this.canEdit,
      isTaken: () => this.context.isCovered() || (this.handles.isHot && !this.isOnKeyframe()),
      keyframePlaces: () => this.context.places(),
      pick: (ray) => sceneView.pick(ray),
      onSelectKeyframe: (keyframe) => actions.select({ keyframe }),
      onSelectObject: (hit) => this.context.onPicked(hit),
      onFocus: (point) => void navigation.controls.setOrbitPoint(point.x, point.y, point.z),
      onDrag: (index, place, surface) => this.dragKeyframe(index, place, surface),
      onRelease: (index) => {
        if (this.dragged) actions.setKeyframe(index, this.dragged, 'full');
        this.dragged = undefined;
      },
      setNavigation: (isEnabled) => {
        navigation.controls.enabled = isEnabled;
        this.handles.isEnabled = isEnabled;
      },
    });
  }

  /** Whether the mouse is where the handles of a keyframe leave it to a drag as that of any keyframe, which is level. */
  private isOnKeyframe(): boolean {
    const { selection } = this.context.store.now;
    return this.handles.isMiddleHot && selection !== undefined && 'keyframe' in selection;
  }

  private dragKeyframe(index: number, place: Vector3, surface: Hit | undefined): void {
    const { store, actions } = this.context;
    const { request } = store.now;
    const keyframe = request?.keyframes[index];
    if (!keyframe) return;
    const margin_m = 1.5 * (request.camera?.near ?? 0) + kSurfaceMargin_m;
    const at = surface ? place.clone().addScaledVector(surface.normal, margin_m) : place;
    const position = this.context.frame().toPose(at, new Quaternion()).position;
    this.dragged = { position, orientation: keyframe.orientation };
    actions.setKeyframe(index, this.dragged, 'draft');
  }

  /** Moves what is selected by a step to the right, up and back, as the view has these directions. `letGo` ends drafts. */
  nudge([right, up, back]: Vec3, step_m: number, kind: PlanKind): void {
    const upward = upVector(this.context.up());
    const ahead = this.context.navigation.camera.getWorldDirection(new Vector3());
    ahead.addScaledVector(upward, -ahead.dot(upward)).normalize();
    const step = ahead.clone().cross(upward).multiplyScalar(right * step_m);
    step.addScaledVector(upward, up * step_m).addScaledVector(ahead, -back * step_m);
    this.changeSelected(kind, ({ position, orientation }) => ({ position: position.add(step), orientation }));
  }

  /** Turns what is selected about the upward axis, and up about its own right. `letGo` ends drafts. */
  turn(yaw_deg: number, pitch_deg: number, kind: PlanKind): void {
    const yaw = new Quaternion().setFromAxisAngle(upVector(this.context.up()), (yaw_deg * Math.PI) / 180);
    const pitch = new Quaternion().setFromAxisAngle(new Vector3(1, 0, 0), (pitch_deg * Math.PI) / 180);
    this.changeSelected(kind, ({ position, orientation }) => ({ position, orientation: yaw.multiply(orientation).multiply(pitch) }));
  }

  /** No key is held down any more: what it moved gets its last answer. */
  letGo(): void {
    const { held } = this;
    this.held = undefined;
    if (!held) return;
    if (this.target()?.key === held.key) this.dragHandle(held.position, held.orientation, 'full');
    else this.context.actions.plan('full');
  }

  private changeSelected(kind: PlanKind, change: (pose: LocalPose) => LocalPose): void {
    const target = this.target();
    if (!target) return;
    const { position, orientation } = change(target);
    const { selection } = this.context.store.now;
    const isDraft = kind === 'draft' && selection !== undefined && 'keyframe' in selection; // objects have no drafts
    this.held = isDraft ? { key: target.key, position, orientation } : undefined;
    this.dragHandle(position, orientation, kind);
  }
}
