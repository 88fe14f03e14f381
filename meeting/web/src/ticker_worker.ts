// SPDX-License-Identifier: Apache-2.0
// Runs in a worker: posts the number of a timer each time it is due. An interval of 0 ms ends it.

const timers = new Map<number, ReturnType<typeof setInterval>>();

self.onmessage = (e: MessageEvent<{ id: number; ms: number }>) => {
  const { id, ms } = e.data;
  clearInterval(timers.get(id));
  timers.delete(id);
  if (ms > 0)
    timers.set(
      id,
      setInterval(() => self.postMessage(id), ms),
    );
};
