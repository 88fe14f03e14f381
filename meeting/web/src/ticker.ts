// SPDX-License-Identifier: Apache-2.0
// Timers that run in hidden pages. Browsers delay their timers by up to a minute, so that the broker would take the page for
// gone; timers of a worker are not delayed.

type Work = () => void;

interface Clock {
  set(work: Work, ms: number): number;
  clear(id: number): void;
}

let shared: Clock | null = null;

function workerClock(): Clock {
  const all = new Map<number, { what: Work; ms: number; own?: number }>();
  const worker = new Worker(new URL("./ticker_worker.ts", import.meta.url), { type: "module" });
  let last = 0;
  let broken = false;
  worker.onmessage = (e: MessageEvent<number>) => all.get(e.data)?.what();
  worker.onerror = () => {
    broken = true; // the worker could not start: use delayed timers
    for (const t of all.values()) t.own = window.setInterval(t.what, t.ms);
  };
  return {
    set(what, ms) {
      const timer: { what: Work; ms: number; own?: number } = { what, ms };
      if (broken) timer.own = window.setInterval(what, ms);
      else worker.postMessage({ id: last + 1, ms });
      all.set(++last, timer);
      return last;
    },
    clear(id) {
      window.clearInterval(all.get(id)?.own);
      all.delete(id);
      if (!broken) worker.postMessage({ id, ms: 0 });
    },
  };
}

const plain: Clock = {
  set: (work, ms) => window.setInterval(work, ms),
  clear: (id) => window.clearInterval(id),
};

function clock(): Clock {
  if (shared) return shared;
  try {
    shared = workerClock();
  } catch {
    shared = plain; // a browser without workers
  }
  return shared;
}

/** As setInterval and clearInterval. */
export const steadyTimer = {
  set: (work: Work, ms: number): number => clock().set(work, ms),
  clear: (id: number): void => clock().clear(id),
};
