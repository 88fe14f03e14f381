// SPDX-License-Identifier: Apache-2.0
// Pointers and keys on the picture of the meeting.

import type { Rig } from "../rig";

export function control(canvas: HTMLCanvasElement, rig: Rig): void {
  const down = new Map<number, { x: number; y: number }>();

  const spread = (): number => {
    const [a, b] = [...down.values()];
    return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
  };

  canvas.addEventListener("pointerdown", (e) => {
    if (e.button !== 0) return;
    canvas.setPointerCapture(e.pointerId);
    down.set(e.pointerId, { x: e.clientX, y: e.clientY });
  });
  canvas.addEventListener("pointermove", (e) => {
    const before = down.get(e.pointerId);
    if (!before) return;
    const wide = spread();
    down.set(e.pointerId, { x: e.clientX, y: e.clientY });
    if (down.size === 1) {
      const h = Math.max(1, canvas.clientHeight);
      rig.drag((e.clientX - before.x) / h, (e.clientY - before.y) / h);
    } else if (wide > 0 && spread() > 0) {
      rig.scale(wide / spread());
    }
  });
  const up = (e: PointerEvent): void => void down.delete(e.pointerId);
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener(
    "wheel",
    (e) => {
      e.preventDefault();
      const lines = e.deltaMode === 1 ? 20 : 1;
      rig.scale(Math.exp(Math.max(-200, Math.min(200, e.deltaY * lines)) * 0.0012));
    },
    { passive: false },
  );
  canvas.addEventListener("keydown", (e) => {
    if (e.ctrlKey || e.altKey || e.metaKey || !rig.key(e.key)) return;
    e.preventDefault();
    e.stopPropagation();
  });
}
