// SPDX-License-Identifier: MIT
// The canvas: draws when something changed, and never otherwise.

import { ColorManagement, LinearSRGBColorSpace, Scene, Vector4, WebGLRenderer } from 'three';
import type { PerspectiveCamera } from 'three';
import type { Part } from './camera_views.js';
import { FrameFence } from './frame_fence.js';
import type { Rgb, TubeUniforms } from './tubes.js';

// All colours are given as they are shown; nothing is lit by physics here.
ColorManagement.enabled = false;

const kMostPixelRatio = 2;
const kLongestStep_s = 0.1;

export interface Drawing {
  camera: PerspectiveCamera;
  part: Part | undefined;
  /** Runs before and after the drawing, to show and hide. */
  before?: () => void;
  after?: () => void;
}

export interface DrawCount {
  draws: number;
  triangles: number;
  /** Time that the calls for one frame took; the GPU may take longer. */
  frame_ms: number;
}

export class Stage {
  readonly canvas = document.createElement('canvas');
  readonly scene = new Scene();
  readonly tubes: TubeUniforms = { viewHeight: { value: 1 }, fade_m: { value: 0 } };
  private readonly renderer: WebGLRenderer;
  private readonly fence: FrameFence;
  private isDue = false;
  private isLeft = false;
  private last_ms = 0;
  private size: [number, number] = [1, 1];

  /** `onFrame` moves things, and returns whether the next frame is due as well; `drawings` says what to draw. */
  constructor(
    private readonly host: HTMLElement,
    private readonly onFrame: (elapsed_s: number) => boolean,
    private readonly drawings: () => Drawing[],
    private readonly onDrawn: (count: DrawCount) => void,
    private readonly onResize: (width: number, height: number) => void,
    /** Called when the GPU has finished the frame that was drawn last. */
    private readonly onFinished: () => void,
  ) {
    this.renderer = new WebGLRenderer({ canvas: this.canvas, antialias: true, powerPreference: 'high-performance' });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.autoClear = false;
    this.renderer.info.autoReset = false;
    this.fence = new FrameFence(this.renderer.getContext() as WebGL2RenderingContext);
    this.canvas.addEventListener('webglcontextrestored', () => this.invalidate());
    // The next page of this tab would wait for frames that nobody sees.
    window.addEventListener('pagehide', () => (this.isLeft = true));
    window.addEventListener('pageshow', ({ persisted }) => {
      this.isLeft = false;
      if (persisted) this.invalidate();
    });
    host.prepend(this.canvas);
    new ResizeObserver(() => this.resize()).observe(host);
    this.resize();
  }

  /** Names what keeps the last frame from being there: another one is due, or the GPU has not finished it. */
  get missing(): string[] {
    return [...(this.isDue ? ['frame'] : []), ...(this.fence.isPassed ? [] : ['GPU'])];
  }

  get pixelRatio(): number {
    return this.renderer.getPixelRatio();
  }

  get width(): number {
    return this.size[0];
  }

  get height(): number {
    return this.size[1];
  }

  setBack(colour: Rgb): void {
    const [r, g, b] = colour.map((x) => Math.round(255 * x)) as [number, number, number];
    this.renderer.setClearColor((r << 16) | (g << 8) | b, 1);
  }

  /** Asks for a frame. */
  invalidate(): void {
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame((now_ms) => this.frame(now_ms));
  }

  private resize(): void {
    const width = Math.max(this.host.clientWidth, 1);
    const height = Math.max(this.host.clientHeight, 1);
    this.size = [width, height];
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, kMostPixelRatio));
    this.renderer.setSize(width, height, false);
    this.onResize(width, height);
    // At once, since a canvas that was resized is empty until it is drawn.
    if (this.last_ms > 0) this.draw(performance.now());
    this.invalidate();
  }

  private frame(now_ms: number): void {
    this.isDue = false;
    if (this.isLeft) return;
    if (this.fence.isPassed) this.draw(now_ms);
    else this.invalidate();
  }

  private draw(now_ms: number): void {
    const elapsed_s = Math.min(Math.max(now_ms - this.last_ms, 0) / 1000, kLongestStep_s);
    const goesOn = this.onFrame(this.last_ms === 0 ? 0 : elapsed_s);
    this.last_ms = now_ms;
    const begin_ms = performance.now();
    this.renderer.info.reset();
    this.renderer.setScissorTest(false);
    this.renderer.setViewport(new Vector4(0, 0, this.width, this.height));
    this.renderer.clear();
    for (const drawing of this.drawings()) this.drawOne(drawing);
    const { calls, triangles } = this.renderer.info.render;
    this.fence.set();
    this.onDrawn({ draws: calls, triangles, frame_ms: performance.now() - begin_ms });
    this.watchEnd();
    if (goesOn) this.invalidate();
    else this.last_ms = now_ms;
  }

  /** Tells of the end of a frame after which no other one is due. */
  private watchEnd(): void {
    requestAnimationFrame(() => {
      if (this.isDue || this.isLeft) return;
      if (this.fence.isPassed) this.onFinished();
      else this.watchEnd();
    });
  }

  private drawOne({ camera, part, before, after }: Drawing): void {
    const { x, y, width, height } = part ?? { x: 0, y: 0, width: this.width, height: this.height };
    this.tubes.viewHeight.value = height;
    this.renderer.setViewport(x, y, width, height);
    if (part) {
      this.renderer.setScissor(x, y, width, height);
      this.renderer.setScissorTest(true);
      this.renderer.clear();
    }
    before?.();
    this.renderer.render(this.scene, camera);
    after?.();
    this.renderer.setScissorTest(false);
  }
}
