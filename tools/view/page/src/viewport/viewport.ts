// SPDX-License-Identifier: MIT
// The view of the scene: it listens to the store, and what the mouse does in it becomes actions.

import { Quaternion, Ray, Sphere, Vector3 } from 'three';
import type { Vec3 } from '../contract/request.js';
import type { Actions, Pose } from '../model/actions.js';
import { poseAt } from '../model/path.js';
import { pathOf } from '../model/stops.js';
import type { State, Store } from '../model/store.js';
import { CameraViews } from './camera_views.js';
import type { CameraMode } from './camera_views.js';
import { Content } from './content.js';
import type { Picked } from './content.js';
import { Editing } from './editing.js';
import { Extent } from './extent.js';
import type { TriangleSource } from './findings_view.js';
import { Frame, toQuaternion, upVector, uprightAxis } from './frame.js';
import type { UpAxis } from './frame.js';
import type { HandleMode } from './handles.js';
import { Labels } from './labels.js';
import { findFloors } from './levels.js';
import { Navigation } from './navigation.js';
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
  /** The name of the part of an object that is within a reach of a point of the world. */
  part: (point: Vec3, reach_m: number) => Promise<string | undefined>;
  triangles: TriangleSource;
}

export interface ViewReport extends DrawCount {
  shownTriangles: number;
  sceneTriangles: number;
  error_m: number;
}

/** While somebody walks, lines nearer than that are not drawn. */
const kWalkFade_m = 0.8;
/** New objects are put that far off the surface that the view looks at, and that far ahead if there is none. */
const kOffSurface_m = 0.3;
const kAhead_m = 3;
/** A part of the path this near to the point of a click on a surface was clicked. */
const kPartReach_m = 0.01;
/** Of a person who stands. */
const kEyeHeight_m = 1.6;
/** Surfaces that are gone through on the way down, and how far behind each of them the next one is looked for. */
const kMostRoofs = 8;
const kThrough_m = 0.001;

export class Viewport {
  readonly section: Section;
  readonly navigation: Navigation;
  private readonly host: HTMLElement;
  private readonly stage: Stage;
  private readonly look = makeSurfaceLook();
  private readonly sceneView: SceneView;
  readonly editing: Editing;
  private readonly content: Content;
  private readonly extent: Extent;
  private readonly cameraViews: CameraViews;
  private readonly labels: Labels;
  private frame = new Frame();
  private sceneName: string | undefined;
  private theme: Theme = readTheme();
  private up: UpAxis = 'y';
  private isUpChosen = false;
  private isPlaced = false;
  private isFast = false;
  private dirty = { content: true, cursor: true };
  private picked: Picked | undefined;
  private floorsKey = '';
  private floors: number[] = [];

  constructor(
    host: HTMLElement,
    private readonly store: Store,
    private readonly actions: Actions,
    private readonly sources: Sources,
    private readonly onDrawn: (report: ViewReport) => void,
    /** Called when the frame of the last report is on the screen. */
    onFinished: () => void,
  ) {
    this.host = host;
    const part = (name: string): HTMLElement => host.querySelector<HTMLElement>(`[data-part="${name}"]`) ?? host;
    this.stage = new Stage(host, (s) => this.advance(s), () => this.drawings(), (count) => this.report(count), (w, h) => this.resized(w, h), onFinished);
    const invalidate = (): void => this.stage.invalidate();
    this.extent = new Extent(store, () => this.frame, () => this.up);
    this.sceneView = new SceneView(this.look, this.stage.tubes.viewHeight, sources.mesh, invalidate, (message) => store.set({ message }));
    this.labels = new Labels(part('labels'));
    this.cameraViews = new CameraViews(part('camera-views'));
    this.section = new Section(part('section'), this.look.section, invalidate);
    const { canvas, scene, tubes } = this.stage;
    this.navigation = new Navigation(canvas, invalidate);
    this.navigation.setSize(this.stage.width, this.stage.height);
    this.content = new Content(tubes, this.look.section, this.extent, invalidate);
    this.editing = new Editing({
      store,
      actions,
      stage: this.stage,
      navigation: this.navigation,
      sceneView: this.sceneView,
      extent: this.extent,
      frame: () => this.frame,
      up: () => this.up,
      places: () => this.content.places,
      isCovered: () => this.cameraViews.mode === 'full',
      onPicked: (hit) => this.pick(hit),
    });
    scene.add(this.sceneView.group, this.content.group);
    this.applyTheme();
    store.listen((now, before) => this.follow(now, before));
  }

  // The view, for keys and buttons.

  /** The pose of the view, for a keyframe or an object. */
  get viewPose(): Pose {
    const { camera } = this.navigation;
    return this.frame.toPose(camera.position, camera.getWorldQuaternion(new Quaternion()));
  }

  /** Whether the view is from outside of the scene. */
  get isOutside(): boolean {
    return !this.extent.scene.containsPoint(this.navigation.camera.position);
  }

  /** Where the view looks: just off the surface in its middle, or ahead if there is none. */
  get viewTarget(): Vec3 {
    const { camera, controls, mode } = this.navigation;
    const ray = new Ray(camera.position.clone(), camera.getWorldDirection(new Vector3()));
    const reach_m = mode === 'walk' ? kAhead_m : controls.distance;
    const hit = this.sceneView.pick(ray, 3 * reach_m);
    const place = hit ? hit.point.addScaledVector(hit.normal, kOffSurface_m) : ray.at(reach_m, new Vector3());
    return this.frame.toPose(place, new Quaternion()).position;
  }

  /** Names what is still to be drawn, except of meshes that are on their way. */
  get missing(): string[] {
    const edges = this.sceneView.hasEdges ? [] : ['edges'];
    return [...this.stage.missing, ...edges, ...(this.content.isComplete ? [] : ['triangles'])];
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
    return this.editing.handles.mode;
  }

  set handleMode(mode: HandleMode) {
    this.editing.handles.mode = mode;
    this.stage.invalidate();
  }

  get cameraMode(): CameraMode {
    return this.cameraViews.mode;
  }

  set cameraMode(mode: CameraMode) {
    this.cameraViews.setMode(mode);
    this.host.dataset['camera'] = mode;
    this.dirty.cursor = true;
    this.stage.invalidate();
  }

  set speedUp(isFast: boolean) {
    this.isFast = isFast;
  }

  toggleSection(): void {
    this.section.toggle(this.extent.pathRange[1]);
  }

  toggleWalk(): void {
    if (this.navigation.mode === 'walk') this.navigation.setMode('orbit');
    else this.beginWalk();
    this.modeChanged();
  }

  /** From within the scene it goes on as it is; from above or outside, people come down to where they look. */
  private beginWalk(): void {
    const { camera } = this.navigation;
    const up = upVector(this.up);
    const isWithin = this.extent.scene.containsPoint(camera.position) && camera.position.dot(up) <= this.section.cutHeight;
    const forward = camera.getWorldDirection(new Vector3());
    const eye = isWithin ? undefined : this.landing(new Ray(camera.position.clone(), forward.clone()));
    if (!eye) {
      this.navigation.setMode('walk');
      return;
    }
    const level = forward.addScaledVector(up, -forward.dot(up));
    if (level.lengthSq() < 1e-6) level.set(0, 1, 0).applyQuaternion(camera.quaternion);
    this.navigation.walkFrom(eye, level.normalize());
  }

  /** The eye of somebody who comes down along a ray: through a roof, whoever stands on which is outside of the scene. */
  private landing(ray: Ray): Vector3 | undefined {
    let first: Vector3 | undefined;
    for (let met = 0; met < kMostRoofs; ++met) {
      const hit = this.sceneView.pick(ray);
      if (!hit) break;
      const eye = hit.point.clone().addScaledVector(upVector(this.up), kEyeHeight_m);
      if (this.extent.scene.containsPoint(eye)) return eye;
      first ??= eye;
      ray.origin.copy(hit.point).addScaledVector(ray.direction, kThrough_m);
    }
    return first;
  }

  /** Puts the view where the camera is at the cursor. */
  walkFromCursor(): void {
    const pose = poseAt(pathOf(this.store.now), this.store.now.cursor_s);
    if (!pose) return;
    this.navigation.walkFrom(this.frame.toLocal(pose.position), new Vector3(0, 0, -1).applyQuaternion(toQuaternion(pose.orientation)));
    this.modeChanged();
  }

  /** In a walk nothing is cut off, and lines that are in the way of the eye are not drawn. */
  private modeChanged(): void {
    const isWalk = this.navigation.mode === 'walk';
    this.section.pause(isWalk);
    this.stage.tubes.fade_m.value = isWalk ? kWalkFade_m : 0;
    this.stage.invalidate();
  }

  /** Shows the path, or the scene if there is none. */
  home(isSmooth = true): void {
    const sphere = this.extent.pathSphere ?? this.extent.sceneSphere;
    this.navigation.fit(sphere, this.extent.homeDirection, isSmooth);
    this.modeChanged();
    this.section.openAbove(this.extent.pathRange[1]);
  }

  showScene(): void {
    this.navigation.fit(this.extent.sceneSphere, this.extent.homeDirection, true);
    this.modeChanged();
    this.section.cutAt(Infinity);
  }

  showSelection(): void {
    const { selection, request } = this.store.now;
    if (selection && 'keyframe' in selection) {
      const keyframe = request?.keyframes[selection.keyframe];
      if (keyframe) this.navigation.fit(this.extent.around(keyframe.position), undefined, true);
    } else if (selection) {
      const bounds = this.store.now.scene?.objects.find(({ name }) => name === selection.object)?.bounds;
      if (bounds) this.navigation.fit(this.extent.boxOf(bounds).getBoundingSphere(new Sphere()), undefined, true);
    } else {
      this.home();
    }
    this.modeChanged();
  }

  applyTheme(): void {
    this.theme = readTheme();
    this.stage.setBack(this.theme.back);
    this.look.surface.value.set(...this.theme.surface);
    this.look.cut.value.set(...this.theme.cut);
    this.look.edge.value.set(...this.theme.edge);
    this.look.edgeOpacity.value = this.theme.edgeOpacity;
    this.dirty = { content: true, cursor: true };
    this.stage.invalidate();
  }

  /** Where a point of the world is on the page, in CSS pixels of the window; undefined if it is out of the view. */
  screenOf(point: Vec3): [number, number] | undefined {
    const { camera } = this.navigation;
    camera.updateMatrixWorld();
    const place = this.frame.toLocal(point).project(camera);
    if (place.toArray().some((x) => Math.abs(x) > 1)) return undefined;
    const box = this.stage.canvas.getBoundingClientRect();
    return [box.left + (place.x * 0.5 + 0.5) * box.width, box.top + (0.5 - place.y * 0.5) * box.height];
  }

  /** The handle that the mouse has at a place of the page, in CSS pixels of the window; null if there is none. */
  handleAt([x, y]: [number, number]): string | null {
    const box = this.stage.canvas.getBoundingClientRect();
    return this.editing.handles.axisAt((2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height);
  }

  // The state of the store.

  private follow(now: State, before: State): void {
    if (now.moves !== before.moves) {
      this.sceneView.setMoves(now.moves);
      this.editing.update();
    }
    if (now.scene !== before.scene && now.scene) void this.showScenes(now);
    const isContent =
      now.answer !== before.answer || now.request !== before.request || now.before !== before.before ||
      now.selection !== before.selection || now.scene !== before.scene;
    const isCursor = isContent || now.cursor_s !== before.cursor_s;
    if (now.selection !== before.selection) this.select(now);
    if (now.scene !== before.scene) this.unpickMoved(now, before);
    this.dirty.content ||= isContent;
    this.dirty.cursor ||= isCursor;
    if (now.answer !== before.answer || now.isDraft !== before.isDraft) this.showFindings(now);
    if (isCursor) this.stage.invalidate();
    if (!this.isPlaced && now.scene && now.request) this.showOpened();
  }

  private async showScenes(now: State): Promise<void> {
    if (!now.scene) return;
    const { name, bounds } = now.scene.scene;
    if (name !== this.sceneName) {
      this.sceneName = name;
      const middle = (axis: 0 | 1 | 2): number => Math.round((bounds.min[axis] + bounds.max[axis]) / 2);
      this.frame = new Frame([middle(0), middle(1), middle(2)]);
      this.isPlaced = false;
      this.dirty = { content: true, cursor: true };
      this.showOpened();
      this.showFindings(now);
    }
    this.navigation.setReach(this.extent.sceneSphere.radius);
    await this.sceneView.show(now.scene, this.frame);
    this.updateSection();
  }

  /** Shows a request that was opened, once it is known in which scene. */
  showOpened(): void {
    const { scene, request } = this.store.now;
    if (!scene) return;
    this.isPlaced = request !== undefined;
    if (!this.isUpChosen) {
      const { min, max } = scene.scene.bounds;
      const isFlat = max[2] - min[2] < 0.5 * (max[1] - min[1]);
      this.applyUp(uprightAxis(request) ?? (isFlat ? 'z' : 'y'));
    }
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
    const { scene } = this.extent;
    const zero = up.dot(new Vector3(...this.frame.origin));
    // Floors are looked for in new shapes, and not whenever a crate moves.
    const key = `${this.up} ${this.sceneView.shapesShown.map(({ shape }) => shape.geometry.id).join()}`;
    if (key !== this.floorsKey) this.floors = findFloors(this.sceneView, up);
    this.floorsKey = key;
    this.section.setScene(up, [up.dot(scene.min), up.dot(scene.max)], this.floors, zero);
  }

  private showFindings(now: State): void {
    this.content.showFindings(now, this.frame, this.sources.triangles);
    this.stage.invalidate();
  }

  private select({ selection }: State): void {
    const name = selection && 'object' in selection ? selection.object : undefined;
    if (this.picked && this.picked.name !== name) this.picked = undefined;
    this.sceneView.highlight(name, this.theme.object);
  }

  /** The place that was clicked is no more on an object that has moved. */
  private unpickMoved(now: State, before: State): void {
    const digestIn = ({ scene }: State): string | undefined => scene?.objects.find(({ name }) => name === this.picked?.name)?.digest;
    if (digestIn(now) !== digestIn(before)) this.picked = undefined;
  }

  // Frames.

  private advance(elapsed_s: number): boolean {
    const goesOn = this.navigation.update(elapsed_s, this.isFast);
    const { now } = this.store;
    if (this.dirty.content) {
      this.content.showPath(now, this.frame, this.theme, this.stage.pixelRatio);
      this.labels.show(this.content.labels(now, this.picked));
      this.editing.update();
    }
    if (this.dirty.cursor) this.content.showCursor(now, this.frame, this.theme, this.cameraViews);
    this.dirty = { content: false, cursor: false };
    this.navigation.camera.updateMatrixWorld();
    const isFull = this.cameraViews.mode === 'full';
    const canvas = this.stage.canvas.getBoundingClientRect();
    const covered = this.cameraViews.parts(canvas).map(({ part }) => part);
    this.labels.place(this.navigation.camera, this.stage.width, this.stage.height, !isFull, covered);
    return goesOn;
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
    this.content.group.visible = areVisible;
    this.editing.handles.visible = areVisible && !this.editing.isDragging;
  }

  private report(count: DrawCount): void {
    const { shown, triangles, error_m } = this.sceneView.count;
    this.onDrawn({ ...count, shownTriangles: shown, sceneTriangles: triangles, error_m });
  }

  private resized(width: number, height: number): void {
    // The stage tells its size when it is made, before there is a navigation.
    this.navigation?.setSize(width, height);
  }

  /** Names the part that was clicked, where the object is a file with names in it. */
  private async namePart(picked: Picked): Promise<void> {
    const reach_m = Math.max(kPartReach_m, this.sceneView.count.error_m);
    const { position } = this.frame.toPose(picked.point, new Quaternion());
    const part = await this.sources.part(position, reach_m).catch(() => undefined);
    if (this.picked !== picked || part === picked.name) return;
    picked.part = part;
    this.dirty.content = true;
    this.stage.invalidate();
  }

  private pick(hit: Hit | undefined): void {
    this.picked = hit && { name: hit.name, point: hit.point, part: undefined };
    if (this.picked) void this.namePart(this.picked);
    this.actions.select(hit && { object: hit.name });
    this.dirty.content = true;
    this.stage.invalidate();
  }
}
