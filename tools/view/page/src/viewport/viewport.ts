// SPDX-License-Identifier: MIT
// The view of the scene: it listens to the store, and what the mouse does in it becomes actions.

import { Box3, Quaternion, Sphere, Vector3 } from 'three';
import type { Vec3 } from '../contract/request.js';
import type { Actions, Pose } from '../model/actions.js';
import { poseAt } from '../model/path.js';
import { pathOf } from '../model/stops.js';
import type { State, Store } from '../model/store.js';
import { TimeMap } from '../model/times.js';
import { kDefaultCamera } from './bodies.js';
import { CameraViews } from './camera_views.js';
import type { CameraMode, Eye } from './camera_views.js';
import { CursorView } from './cursor_view.js';
import { FindingsView } from './findings_view.js';
import type { TriangleSource } from './findings_view.js';
import { Frame, toQuat, toQuaternion, upVector, uprightAxis } from './frame.js';
import type { UpAxis } from './frame.js';
import { Handles } from './handles.js';
import type { HandleMode } from './handles.js';
import { KeyframesView } from './keyframes_view.js';
import { Labels } from './labels.js';
import type { Label } from './labels.js';
import { findFloors } from './levels.js';
import { Navigation } from './navigation.js';
import { PathView } from './path_view.js';
import { Pointer } from './pointer.js';
import { SceneView } from './scene_view.js';
import type { Hit, MeshSource } from './scene_view.js';
import { Section } from './section.js';
import { Stage } from './stage.js';
import type { DrawCount, Drawing } from './stage.js';
import { makeSurfaceLook } from './surfaces.js';
import { readTheme } from './theme.js';
import type { Theme } from './theme.js';

export interface Sources {
  mesh: MeshSource;
  triangles: TriangleSource;
}

export interface ViewReport extends DrawCount {
  shownTriangles: number;
  sceneTriangles: number;
  error_m: number;
}

/** Objects that are a larger part of the scene are the building, and are not dragged by accident. */
const kLargestMovable = 0.4;
const kLeastView_m = 2;
const kSurfaceMargin_m = 0.05;
const kDefaultDirection = new Vector3(0.15, 1, 0.75);

export class Viewport {
  readonly section: Section;
  readonly navigation: Navigation;
  private readonly stage: Stage;
  private readonly look = makeSurfaceLook();
  private readonly sceneView: SceneView;
  private readonly pathView: PathView;
  private readonly keyframesView: KeyframesView;
  private readonly cursorView: CursorView;
  private readonly findings: FindingsView;
  private readonly cameraViews: CameraViews;
  private readonly handles: Handles;
  private readonly pointer: Pointer;
  private readonly labels: Labels;
  private frame = new Frame();
  private sceneName: string | undefined;
  private theme: Theme = readTheme();
  private up: UpAxis = 'y';
  private isUpChosen = false;
  private isPlaced = false;
  private isFast = false;
  private dirty = { content: true, cursor: true };
  private picked: { name: string; point: Vector3 } | undefined;
  private dragged: Pose | undefined;

  constructor(
    host: HTMLElement,
    private readonly store: Store,
    private readonly actions: Actions,
    private readonly sources: Sources,
    private readonly onDrawn: (report: ViewReport) => void,
  ) {
    const part = (name: string): HTMLElement => host.querySelector<HTMLElement>(`[data-part="${name}"]`) ?? host;
    this.stage = new Stage(host, (s) => this.advance(s), () => this.drawings(), (count) => this.report(count), (w, h) => this.resized(w, h));
    const invalidate = (): void => this.stage.invalidate();
    this.sceneView = new SceneView(this.look, sources.mesh, invalidate, (message) => store.set({ message }));
    this.labels = new Labels(part('labels'));
    this.cameraViews = new CameraViews(part('camera-views'));
    this.section = new Section(part('section'), this.look.section, invalidate);
    const { canvas, scene, viewHeight } = this.stage;
    this.navigation = new Navigation(canvas, invalidate);
    this.handles = new Handles(this.navigation.camera, canvas, scene, {
      onDrag: (position, orientation) => this.dragHandle(position, orientation, 'draft'),
      onRelease: (position, orientation) => this.dragHandle(position, orientation, 'full'),
      onBusy: (isBusy) => (this.navigation.controls.enabled = !isBusy),
      onChange: invalidate,
    });
    this.pathView = new PathView(viewHeight);
    this.keyframesView = new KeyframesView(viewHeight);
    this.cursorView = new CursorView(viewHeight);
    this.findings = new FindingsView(viewHeight, invalidate);
    scene.add(this.sceneView.group, ...this.overlays);
    this.pointer = this.makePointer();
    this.applyTheme();
    store.listen((now, before) => this.follow(now, before));
    this.follow(store.now, { ...store.now, scene: undefined });
  }

  private get overlays() {
    return [this.pathView.group, this.keyframesView.group, this.cursorView.group, this.findings.group];
  }

  // The view, for keys and buttons.

  /** The pose of the view, for a keyframe or an object. */
  get viewPose(): Pose {
    const { camera } = this.navigation;
    return this.frame.toPose(camera.position, camera.getWorldQuaternion(new Quaternion()));
  }

  /** The point that the view looks at: on a surface if there is one in the middle. */
  get viewTarget(): Vec3 {
    const { camera, controls, mode } = this.navigation;
    const direction = camera.getWorldDirection(new Vector3());
    const reach = mode === 'walk' ? 3 : controls.distance;
    return this.frame.toPose(camera.position.clone().addScaledVector(direction, reach), new Quaternion()).position;
  }

  /** The pose of a keyframe after a step to the right, up and back, as the view has these directions. */
  nudged(index: number, [right, up, back]: Vec3, step_m: number): Pose {
    const keyframe = this.store.now.request?.keyframes[index];
    if (!keyframe) return this.viewPose;
    const upward = upVector(this.up);
    const ahead = this.navigation.camera.getWorldDirection(new Vector3());
    ahead.addScaledVector(upward, -ahead.dot(upward)).normalize();
    const sideways = ahead.clone().cross(upward);
    const place = this.frame.toLocal(keyframe.position).addScaledVector(sideways, right * step_m);
    place.addScaledVector(upward, up * step_m).addScaledVector(ahead, -back * step_m);
    return { position: this.frame.toPose(place, new Quaternion()).position, orientation: keyframe.orientation };
  }

  /** The pose of a keyframe after a turn about the upward axis, and up about its own right. */
  turned(index: number, yaw_deg: number, pitch_deg: number): Pose {
    const keyframe = this.store.now.request?.keyframes[index];
    if (!keyframe) return this.viewPose;
    const yaw = new Quaternion().setFromAxisAngle(upVector(this.up), (yaw_deg * Math.PI) / 180);
    const pitch = new Quaternion().setFromAxisAngle(new Vector3(1, 0, 0), (pitch_deg * Math.PI) / 180);
    const turned = yaw.multiply(toQuaternion(keyframe.orientation)).multiply(pitch);
    return { position: keyframe.position, orientation: toQuat(turned) };
  }

  get upAxis(): UpAxis {
    return this.up;
  }

  setUp(up: UpAxis): void {
    this.isUpChosen = true;
    this.applyUp(up);
    this.home(false);
  }

  get handleMode(): HandleMode {
    return this.handles.mode;
  }

  set handleMode(mode: HandleMode) {
    this.handles.mode = mode;
    this.stage.invalidate();
  }

  get cameraMode(): CameraMode {
    return this.cameraViews.mode;
  }

  set cameraMode(mode: CameraMode) {
    this.cameraViews.setMode(mode);
    this.dirty.cursor = true;
    this.stage.invalidate();
  }

  set speedUp(isFast: boolean) {
    this.isFast = isFast;
  }

  toggleSection(): void {
    this.section.toggle(this.pathRange()[1]);
  }

  toggleWalk(): void {
    this.navigation.setMode(this.navigation.mode === 'walk' ? 'orbit' : 'walk');
    this.section.pause(this.navigation.mode === 'walk');
  }

  /** Puts the view where the camera is at the cursor. */
  walkFromCursor(): void {
    const pose = poseAt(pathOf(this.store.now), this.store.now.cursor_s);
    if (!pose) return;
    this.navigation.walkFrom(this.frame.toLocal(pose.position), toQuaternion(pose.orientation));
    this.section.pause(true);
  }

  /** Shows the path, or the scene if there is none. */
  home(isSmooth = true): void {
    const sphere = this.pathSphere() ?? this.sceneSphere();
    this.navigation.fit(sphere, this.homeDirection(), isSmooth);
    this.section.pause(false);
    this.section.openAbove(this.pathRange()[1]);
  }

  showScene(): void {
    this.navigation.fit(this.sceneSphere(), this.homeDirection(), true);
    this.section.pause(false);
    this.section.cutAt(Infinity);
  }

  showSelection(): void {
    const { selection, request } = this.store.now;
    if (selection && 'keyframe' in selection) {
      const keyframe = request?.keyframes[selection.keyframe];
      if (keyframe) this.navigation.fit(new Sphere(this.frame.toLocal(keyframe.position), kLeastView_m), undefined, true);
    } else if (selection) {
      const bounds = this.sceneView.factsOf(selection.object)?.bounds;
      if (bounds) this.navigation.fit(this.boxOf(bounds).getBoundingSphere(new Sphere()), undefined, true);
    } else {
      this.home();
    }
    this.section.pause(false);
  }

  applyTheme(): void {
    this.theme = readTheme();
    this.stage.setBack(this.theme.back);
    this.look.surface.value.set(...this.theme.surface);
    this.look.cut.value.set(...this.theme.cut);
    this.look.edge.value.set(...this.theme.edge);
    this.look.edgeOpacity.value = this.theme.edgeOpacity;
    this.findings.setLook([...this.theme.rim], this.stage.pixelRatio);
    this.dirty = { content: true, cursor: true };
    this.stage.invalidate();
  }

  /** Where a point of the world is on the page, in CSS pixels of the window; undefined if it is out of the view. */
  screenOf(point: Vec3): [number, number] | undefined {
    const { camera } = this.navigation;
    camera.updateMatrixWorld();
    const place = this.frame.toLocal(point).project(camera);
    if (Math.abs(place.z) > 1) return undefined;
    const box = this.stage.canvas.getBoundingClientRect();
    return [box.left + (place.x * 0.5 + 0.5) * box.width, box.top + (0.5 - place.y * 0.5) * box.height];
  }

  // What the store says.

  private follow(now: State, before: State): void {
    if (now.scene !== before.scene && now.scene) void this.showScenes(now);
    const isContent =
      now.answer !== before.answer || now.request !== before.request || now.before !== before.before ||
      now.selection !== before.selection || now.scene !== before.scene;
    const isCursor = isContent || now.cursor_s !== before.cursor_s;
    if (now.selection !== before.selection) this.select(now);
    this.dirty.content ||= isContent;
    this.dirty.cursor ||= isCursor;
    if (now.answer !== before.answer && !now.isDraft) this.showFindings(now);
    if (isCursor) this.stage.invalidate();
    if (now.request && !this.isPlaced) this.placeFirst();
  }

  private async showScenes(now: State): Promise<void> {
    if (!now.scene) return;
    const { name, bounds } = now.scene.scene;
    if (name !== this.sceneName) {
      this.sceneName = name;
      const middle = (axis: 0 | 1 | 2): number => Math.round((bounds.min[axis] + bounds.max[axis]) / 2);
      this.frame = new Frame([middle(0), middle(1), middle(2)]);
      this.isPlaced = false;
      this.placeFirst();
      this.showFindings(now);
    }
    this.navigation.setReach(this.sceneSphere().radius);
    await this.sceneView.show(now.scene, this.frame);
    this.updateSection();
    this.select(this.store.now);
  }

  /** Places the view when it is known what to show. */
  private placeFirst(): void {
    const { scene, request } = this.store.now;
    if (!scene) return;
    this.isPlaced = request !== undefined && request.keyframes.length > 0;
    if (!this.isUpChosen) {
      const flatZ = scene.scene.bounds;
      const isFlat = flatZ.max[2] - flatZ.min[2] < 0.5 * (flatZ.max[1] - flatZ.min[1]);
      this.applyUp(uprightAxis(request?.keyframes.map(({ orientation }) => orientation) ?? []) ?? (isFlat ? 'z' : 'y'));
    }
    this.updateSection();
    this.home(false);
  }

  private applyUp(up: UpAxis): void {
    this.up = up;
    this.look.up.value.copy(upVector(up));
    this.navigation.setUp(upVector(up));
    this.updateSection();
  }

  private updateSection(): void {
    const up = upVector(this.up);
    const box = this.sceneBox();
    const zero = up.dot(new Vector3(...this.frame.origin));
    this.section.setScene(up, [up.dot(box.min), up.dot(box.max)], findFloors(this.sceneView, up), zero);
  }

  private showFindings(now: State): void {
    void this.findings.show(now.answer, this.frame, now.isDraft ? undefined : this.sources.triangles);
    this.stage.invalidate();
  }

  private select({ selection }: State): void {
    const name = selection && 'object' in selection ? selection.object : undefined;
    if (this.picked && this.picked.name !== name) this.picked = undefined;
    this.sceneView.highlight(name, this.theme.object);
  }

  // Geometry of what there is, in the frame that is drawn.

  private boxOf({ min, max }: { min: Vec3; max: Vec3 }): Box3 {
    return new Box3(this.frame.toLocal(min), this.frame.toLocal(max));
  }

  private sceneBox(): Box3 {
    const bounds = this.store.now.scene?.scene.bounds;
    return bounds ? this.boxOf(bounds) : new Box3(new Vector3(-5, -5, -5), new Vector3(5, 5, 5));
  }

  private sceneSphere(): Sphere {
    return this.sceneBox().getBoundingSphere(new Sphere());
  }

  private pathPoints(): Vector3[] {
    const { request, before, answer } = this.store.now;
    const ends = [...before, ...(answer?.segments ?? [])].flatMap(({ position }) => position);
    return [...(request?.keyframes.map(({ position }) => position) ?? []), ...ends].map((p) => this.frame.toLocal(p));
  }

  private pathSphere(): Sphere | undefined {
    const points = this.pathPoints();
    if (points.length === 0) return undefined;
    const sphere = new Box3().setFromPoints(points).getBoundingSphere(new Sphere());
    sphere.radius = Math.max(1.3 * sphere.radius, kLeastView_m);
    return sphere;
  }

  /** Heights of the path along `up`. */
  private pathRange(): [number, number] {
    const up = upVector(this.up);
    const heights = this.pathPoints().map((point) => point.dot(up));
    if (heights.length > 0) return [Math.min(...heights.slice(0, 50_000)), Math.max(...heights.slice(0, 50_000))];
    const box = this.sceneBox();
    return [up.dot(box.min), up.dot(box.max)];
  }

  /** From above, and across the path, so that it runs from side to side. */
  private homeDirection(): Vector3 {
    const up = upVector(this.up);
    const tilt = new Vector3(kDefaultDirection.x, 0, kDefaultDirection.z);
    if (this.up === 'z') tilt.set(kDefaultDirection.x, -kDefaultDirection.z, 0);
    const keyframes = this.store.now.request?.keyframes ?? [];
    const [first, last] = [keyframes[0], keyframes[keyframes.length - 1]];
    if (first && last) {
      const along = this.frame.toLocal(last.position).sub(this.frame.toLocal(first.position));
      along.addScaledVector(up, -along.dot(up));
      const across = along.clone().cross(up);
      if (across.lengthSq() > 1e-4) {
        if (across.dot(tilt) < 0) across.negate();
        tilt.copy(across.normalize().multiplyScalar(kDefaultDirection.z)).addScaledVector(along.normalize(), kDefaultDirection.x);
      }
    }
    return tilt.addScaledVector(up, kDefaultDirection.y);
  }

  // Frames.

  private advance(elapsed_s: number): boolean {
    const goesOn = this.navigation.update(elapsed_s, this.isFast);
    if (this.dirty.content) this.updateContent();
    if (this.dirty.cursor) this.updateCursor();
    this.dirty = { content: false, cursor: false };
    this.navigation.camera.updateMatrixWorld();
    const isFull = this.cameraViews.mode === 'full';
    this.labels.place(this.navigation.camera, this.stage.width, this.stage.height, !isFull);
    return goesOn;
  }

  private updateContent(): void {
    const { answer, before, request, selection } = this.store.now;
    const { theme } = this;
    const selected = selection && 'keyframe' in selection ? selection.keyframe : undefined;
    const sceneSize_m = this.sceneSphere().radius;
    this.pathView.show(request, answer, before, this.frame, { unproved: theme.ink });
    this.keyframesView.show(
      { request, answer, selected, frame: this.frame, sceneSize_m },
      { given: theme.ink, selected: theme.accent, rim: theme.rim, pixelRatio: this.stage.pixelRatio },
    );
    this.labels.show(this.labelsNow(selected));
    this.handles.show(this.handleTarget());
  }

  private labelsNow(selected: number | undefined): Label[] {
    const { answer, selection } = this.store.now;
    const faults = new Set((answer?.keyframe_faults ?? []).map(({ keyframe }) => keyframe));
    const proof = answer?.infeasibility;
    const suffix = (i: number): string =>
      proof?.keyframe_inside === i ? ' inside' : proof?.keyframe_outside === i ? ' outside' : faults.has(i) ? ' collides' : '';
    const labels = this.keyframesView.places.slice(0, 2000).map((at, i): Label => ({
      text: `${i}${suffix(i)}`,
      at,
      kind: faults.has(i) ? 'invalid' : i === selected ? 'selected' : 'keyframe',
    }));
    if (selection && 'object' in selection) {
      const bounds = this.sceneView.factsOf(selection.object)?.bounds;
      const at = this.picked?.point ?? (bounds ? this.boxOf(bounds).getCenter(new Vector3()) : undefined);
      if (at) labels.unshift({ text: selection.object, at, kind: 'object' });
    }
    // The selected one first: numbers give way to those before them.
    return labels.sort((a, b) => Number(a.kind === 'keyframe') - Number(b.kind === 'keyframe'));
  }

  private updateCursor(): void {
    const { answer, before, request, cursor_s } = this.store.now;
    const path = pathOf(this.store.now);
    const pose = poseAt(path, cursor_s);
    const given_s = new TimeMap(request, answer).toGiven(cursor_s);
    const poseBefore = answer?.segments.length ? poseAt(before, given_s) : undefined;
    const camera = { ...(request?.camera ?? kDefaultCamera) };
    camera.near *= answer?.near_scale ?? 1;
    const size_m = this.sceneSphere().radius;
    this.cursorView.show(request, pose, poseBefore, this.frame, size_m, this.theme.accent, answer?.near_scale ?? 1);
    const eye = (at: Pose | undefined, isColliding: boolean): Eye | undefined =>
      at && { position: this.frame.toLocal(at.position), orientation: toQuaternion(at.orientation), isColliding };
    const collides = (list: readonly { t_begin: number; t_end: number }[] | undefined, t: number): boolean =>
      (list ?? []).some(({ t_begin, t_end }) => t >= t_begin && t <= t_end);
    const isCorrected = (answer?.corrections?.length ?? 0) > 0;
    this.cameraViews.setEyes(
      camera,
      eye(pose, collides(answer?.remaining_collisions, cursor_s)),
      isCorrected ? eye(poseBefore, collides(answer?.collisions, given_s)) : undefined,
      4 * size_m,
    );
  }

  private drawings(): Drawing[] {
    const canvas = this.stage.canvas.getBoundingClientRect();
    const views = this.cameraViews.parts(canvas).map(({ camera, part }): Drawing => {
      const section = this.look.section.value.clone();
      return {
        camera,
        part,
        before: () => {
          this.showOverlays(false);
          this.look.section.value.set(0, 0, 0, 0);
        },
        after: () => {
          this.showOverlays(true);
          this.look.section.value.copy(section);
        },
      };
    });
    const isFull = this.cameraViews.mode === 'full' && views.length > 0;
    return isFull ? views : [{ camera: this.navigation.camera, part: undefined }, ...views];
  }

  private showOverlays(areVisible: boolean): void {
    for (const overlay of this.overlays) overlay.visible = areVisible;
    this.handles.visible = areVisible;
  }

  private report(count: DrawCount): void {
    const { shown, triangles, error_m } = this.sceneView.count;
    this.onDrawn({ ...count, shownTriangles: shown, sceneTriangles: triangles, error_m });
  }

  private resized(width: number, height: number): void {
    // The stage tells its size when it is made, before there is a navigation.
    this.navigation?.setSize(width, height);
  }

  // What the mouse does.

  private get canEdit(): boolean {
    return this.store.now.connection !== 'review';
  }

  private handleTarget() {
    const { selection, request, isReadOnly } = this.store.now;
    if (!selection || !this.canEdit) return undefined;
    if ('keyframe' in selection) {
      const keyframe = request?.keyframes[selection.keyframe];
      if (!keyframe) return undefined;
      const position = this.frame.toLocal(keyframe.position);
      return { key: `keyframe ${selection.keyframe}`, position, orientation: toQuaternion(keyframe.orientation) };
    }
    const facts = this.sceneView.factsOf(selection.object);
    if (!facts || isReadOnly) return undefined;
    const share = this.boxOf(facts.bounds).getSize(new Vector3()).length() / (2 * this.sceneSphere().radius);
    if (share > kLargestMovable) return undefined;
    return {
      key: `object ${facts.name}`,
      position: this.frame.toLocal(facts.position),
      orientation: toQuaternion(facts.orientation),
    };
  }

  private dragHandle(position: Vector3, orientation: Quaternion, kind: 'draft' | 'full'): void {
    const { selection } = this.store.now;
    const pose = this.frame.toPose(position, orientation);
    if (!selection) return;
    if ('keyframe' in selection) {
      this.actions.setKeyframe(selection.keyframe, pose, kind);
      return;
    }
    this.sceneView.preview(selection.object, position, pose.orientation);
    this.actions.moveObject(selection.object, pose);
    this.stage.invalidate();
  }

  private makePointer(): Pointer {
    const { navigation, keyframesView, look, stage } = this;
    return new Pointer({
      element: stage.canvas,
      camera: navigation.camera,
      get up() {
        return look.up.value;
      },
      canDrag: () => this.canEdit,
      isTaken: () => this.handles.isHot || this.cameraViews.mode === 'full',
      keyframePlaces: () => keyframesView.places,
      pick: (ray) => this.sceneView.pick(ray),
      onSelectKeyframe: (keyframe) => this.actions.select({ keyframe }),
      onSelectObject: (hit) => this.selectHit(hit),
      onFocus: (point) => void navigation.controls.setOrbitPoint(point.x, point.y, point.z),
      onDrag: (index, place, surface) => this.dragKeyframe(index, place, surface),
      onRelease: (index) => {
        if (this.dragged) this.actions.setKeyframe(index, this.dragged, 'full');
        this.dragged = undefined;
      },
      setNavigation: (isEnabled) => (navigation.controls.enabled = isEnabled),
    });
  }

  private selectHit(hit: Hit | undefined): void {
    this.picked = hit;
    this.actions.select(hit && { object: hit.name });
    this.dirty.content = true;
    this.stage.invalidate();
  }

  private dragKeyframe(index: number, place: Vector3, surface: Hit | undefined): void {
    const { request } = this.store.now;
    const keyframe = request?.keyframes[index];
    if (!keyframe) return;
    const margin_m = 1.5 * (request.camera?.near ?? 0) + kSurfaceMargin_m;
    const at = surface ? place.clone().addScaledVector(surface.normal, margin_m) : place;
    this.dragged = { position: this.frame.toPose(at, new Quaternion()).position, orientation: keyframe.orientation };
    this.actions.setKeyframe(index, this.dragged, 'draft');
  }

  get isDragging(): boolean {
    return this.pointer.isDragging || this.handles.isDragging;
  }
}
