// SPDX-License-Identifier: MIT
// The objects of the scene. A new description fetches the meshes that are new alone, and moves the others.

import { Group, LineSegments, Mesh, Raycaster, ShaderMaterial, Vector3 } from 'three';
import type { BufferGeometry, IUniform, Ray } from 'three';
import { acceleratedRaycast } from 'three-mesh-bvh';
import type { ObjectFacts, SceneDescription } from '../contract/door.js';
import type { Pose } from '../model/actions.js';
import { toQuaternion } from './frame.js';
import type { Frame } from './frame.js';
import { disposeShape, makeEdges, makeTree, readShape } from './shapes.js';
import type { Shape } from './shapes.js';
import { makeEdgeMaterial, makeSurfaceMaterial, tint } from './surfaces.js';
import type { SurfaceLook } from './surfaces.js';
import type { Rgb } from './tubes.js';

export type MeshSource = (digest: string) => Promise<ArrayBuffer>;

interface Item {
  facts: ObjectFacts;
  shape: Shape;
  mesh: Mesh<BufferGeometry, ShaderMaterial>;
  lines: LineSegments | undefined;
}

export interface Hit {
  name: string;
  point: Vector3;
  /** Unit normal of the surface there, towards the ray's begin. */
  normal: Vector3;
}

/** The key of a mesh, which is fetched once for all objects that share it, and for one that moves. */
function meshKey({ digest, mesh_digest }: ObjectFacts): string {
  return mesh_digest ?? digest;
}

/** Meshes that are fetched at a time: browsers have six connections to a host. */
const kMostFetches = 5;

export class SceneView {
  readonly group = new Group();
  private readonly items = new Map<string, Item>();
  private moves: ReadonlyMap<string, Pose> = new Map();
  private readonly shapes = new Map<string, Promise<Shape>>();
  private readonly edgeMaterial: ShaderMaterial;
  private update = 0;
  private frame: Frame | undefined;
  private edgeWork: Item[] = [];
  private highlighted: string | undefined;
  private highlightColour: Rgb = [0, 0, 0];

  constructor(
    private readonly look: SurfaceLook,
    viewHeight: IUniform<number>,
    private readonly source: MeshSource,
    /** Hears that something to draw has changed. */
    private readonly onChange: () => void,
    private readonly onError: (sentence: string) => void,
  ) {
    this.edgeMaterial = makeEdgeMaterial(look, viewHeight);
  }

  /** Shows a scene. A later call replaces an earlier one, even if its meshes are not there yet. */
  async show(description: SceneDescription, frame: Frame): Promise<void> {
    const update = ++this.update;
    this.frame = frame;
    for (const facts of description.objects) this.place(facts);
    const names = new Set(description.objects.map(({ name }) => name));
    for (const name of this.items.keys()) if (!names.has(name)) this.remove(name);
    const wanted = description.objects.filter((facts) => !this.isShown(facts));
    const queue = [...wanted];
    const fetchNext = async (): Promise<void> => {
      for (let facts = queue.shift(); facts && update === this.update; facts = queue.shift()) {
        try {
          const shape = await this.shapeOf(facts);
          if (update === this.update) this.add(facts, shape);
        } catch (error) {
          this.shapes.delete(meshKey(facts));
          this.onError(error instanceof Error ? error.message : String(error));
        }
      }
    };
    await Promise.all(Array.from({ length: kMostFetches }, fetchNext));
    if (update === this.update) this.dropUnused(description);
    this.onChange();
  }

  /** Draws the objects of these names at other poses than the scene has them. A later call replaces an earlier one. */
  setMoves(moves: ReadonlyMap<string, Pose>): void {
    const names = [...this.moves.keys(), ...moves.keys()];
    this.moves = moves;
    for (const name of names) {
      const item = this.items.get(name);
      if (item) this.setPose(item);
    }
    this.onChange();
  }

  /** Whether the meshes that are there have all their edges. */
  get hasEdges(): boolean {
    return this.edgeWork.length === 0;
  }

  get shapesShown(): { shape: Shape; mesh: Mesh }[] {
    return [...this.items.values()].map(({ shape, mesh }) => ({ shape, mesh }));
  }

  get count(): { shown: number; triangles: number; error_m: number } {
    let shown = 0;
    let triangles = 0;
    let error_m = 0;
    for (const { shape } of this.items.values()) {
      shown += shape.shown;
      triangles += shape.triangles;
      error_m = Math.max(error_m, shape.error_m);
    }
    return { shown, triangles, error_m };
  }

  /** Highlights an object, also one whose mesh comes later. */
  highlight(name: string | undefined, colour: Rgb): void {
    this.highlighted = name;
    this.highlightColour = colour;
    for (const item of this.items.values()) this.tint(item);
    this.onChange();
  }

  private tint({ facts, mesh }: Item): void {
    tint(mesh.material, facts.name === this.highlighted ? this.highlightColour : undefined);
  }

  /** The first surface that a ray meets on the side of the section plane that is drawn. */
  pick(ray: Ray, far = Infinity): Hit | undefined {
    const caster = new Raycaster(ray.origin, ray.direction, ...this.drawnPart(ray, far));
    caster.firstHitOnly = true;
    const meshes = [...this.items.values()].map(({ shape, mesh }) => {
      makeTree(shape);
      return mesh;
    });
    const hit = caster.intersectObjects(meshes, false)[0];
    if (!hit) return undefined;
    const normal = (hit.face?.normal ?? new Vector3(0, 1, 0)).clone().transformDirection(hit.object.matrixWorld);
    if (normal.dot(ray.direction) > 0) normal.negate();
    return { name: hit.object.name, point: hit.point, normal };
  }

  /** The interval of a ray that lies on the near side of the section plane. */
  private drawnPart(ray: Ray, far: number): [number, number] {
    const plane = this.look.section.value;
    const normal = new Vector3(plane.x, plane.y, plane.z);
    if (normal.lengthSq() === 0) return [0, far];
    const rate = normal.dot(ray.direction);
    const excess = normal.dot(ray.origin) - plane.w;
    if (Math.abs(rate) < 1e-12) return excess > 0 ? [0, 0] : [0, far];
    const crossing = -excess / rate;
    if (excess > 0) return crossing > 0 ? [Math.min(crossing, far), far] : [0, 0];
    return crossing > 0 ? [0, Math.min(crossing, far)] : [0, far];
  }

  private isShown(facts: ObjectFacts): boolean {
    const item = this.items.get(facts.name);
    return item !== undefined && meshKey(item.facts) === meshKey(facts);
  }

  private shapeOf(facts: ObjectFacts): Promise<Shape> {
    const key = meshKey(facts);
    let shape = this.shapes.get(key);
    if (!shape) {
      shape = this.source(facts.digest).then(readShape);
      this.shapes.set(key, shape);
    }
    return shape;
  }

  private add(facts: ObjectFacts, shape: Shape): void {
    this.remove(facts.name);
    const mesh = new Mesh(shape.geometry, makeSurfaceMaterial(this.look, shape.isSolid));
    mesh.name = facts.name;
    mesh.raycast = acceleratedRaycast;
    const item: Item = { facts, shape, mesh, lines: undefined };
    this.items.set(facts.name, item);
    this.tint(item);
    this.group.add(mesh);
    this.setPose(item);
    if (this.edgeWork.push(item) === 1) setTimeout(() => this.makeNextEdges(), 0);
    this.onChange();
  }

  /** Edges come object by object, between frames: the scene is there before all of its lines are. */
  private makeNextEdges(): void {
    const item = this.edgeWork[0];
    if (!item) return;
    const edges = makeEdges(item.shape);
    if (edges) {
      item.lines = new LineSegments(edges, this.edgeMaterial);
      item.lines.renderOrder = 1;
      item.mesh.add(item.lines);
      this.onChange();
    }
    this.edgeWork.shift();
    if (this.edgeWork.length > 0) setTimeout(() => this.makeNextEdges(), 0);
  }

  private place(facts: ObjectFacts): void {
    const item = this.items.get(facts.name);
    if (!item || !this.isShown(facts)) return;
    item.facts = facts;
    this.setPose(item);
    this.onChange();
  }

  private setPose({ facts, mesh, shape }: Item): void {
    if (!this.frame) return;
    const { position, orientation } = this.moves.get(facts.name) ?? facts;
    mesh.quaternion.copy(toQuaternion(orientation));
    const center = shape.center.clone().applyQuaternion(mesh.quaternion);
    mesh.position.copy(this.frame.toLocal([position[0] + center.x, position[1] + center.y, position[2] + center.z]));
    mesh.updateMatrixWorld();
  }

  private remove(name: string): void {
    const item = this.items.get(name);
    if (!item) return;
    item.mesh.removeFromParent();
    item.mesh.material.dispose();
    this.items.delete(name);
    this.edgeWork = this.edgeWork.filter((other, i) => i === 0 || other !== item);
  }

  private dropUnused(description: SceneDescription): void {
    const used = new Set(description.objects.map(meshKey));
    for (const [key, shape] of this.shapes) {
      if (used.has(key)) continue;
      this.shapes.delete(key);
      shape.then(disposeShape, () => undefined);
    }
  }
}
