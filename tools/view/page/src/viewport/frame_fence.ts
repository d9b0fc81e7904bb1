// SPDX-License-Identifier: MIT
// A fence that tells whether the GPU has drawn the last frame. Without it, a slow GPU is sent frame after frame, and
// other work on the GPU, such as the next page of the tab, waits for all of them.

export class FrameFence {
  private sync: WebGLSync | null = null;

  constructor(private readonly context: WebGL2RenderingContext) {}

  /** Sets the fence after the last command of a frame. */
  set(): void {
    this.drop();
    this.sync = this.context.fenceSync(this.context.SYNC_GPU_COMMANDS_COMPLETE, 0);
    this.context.flush();
  }

  /** Returns whether the frame is drawn, or the context is lost. Does not wait. */
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
