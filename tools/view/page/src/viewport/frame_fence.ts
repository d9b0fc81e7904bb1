// SPDX-License-Identifier: MIT
// Whether the GPU has drawn the last frame. Without it, a slow GPU is sent frame after frame, and whatever else needs
// it, such as the next page of the tab, waits for all of them.

export class FrameFence {
  private sync: WebGLSync | null = null;

  constructor(private readonly context: WebGL2RenderingContext) {}

  /** Put after the last command of a frame. */
  set(): void {
    this.drop();
    this.sync = this.context.fenceSync(this.context.SYNC_GPU_COMMANDS_COMPLETE, 0);
    this.context.flush();
  }

  /** Does not wait. True, too, where the context is lost. */
  get isPassed(): boolean {
    if (!this.sync) return true;
    if (this.context.clientWaitSync(this.sync, 0, 0) === this.context.TIMEOUT_EXPIRED) return false;
    this.drop();
    return true;
  }

  private drop(): void {
    if (this.sync) this.context.deleteSync(this.sync);
    this.sync = null;
  }
}
