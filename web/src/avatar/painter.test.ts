// SPDX-License-Identifier: Apache-2.0
import type { Camera, Scene } from "three";
import { beforeEach, describe, expect, it, vi } from "vitest";
import { FakeElement, useFakePage } from "../shared/testing_dom";
import { NoWebGl } from "../shared/graphics";
import { Painter } from "./painter";

const gpu = vi.hoisted(() => ({
  works: true,
  software: false,
  now: 0, // s
  cost: 0, // s of a picture
  done: 0, // s, when the last picture is there
  ratio: 0,
  sizes: [] as string[],
}));

vi.mock("../shared/graphics", async (original) => ({
  ...(await original<object>()),
  drawsInSoftware: () => gpu.software,
}));
vi.mock("three", () => ({
  Color: class {},
  WebGLRenderer: class {
    constructor() {
      if (!gpu.works) throw new Error("Error creating WebGL context.");
    }
    setClearColor(): void {}
    setPixelRatio(ratio: number): void {
      gpu.ratio = ratio;
    }
    setSize(w: number, h: number): void {
      gpu.sizes.push(`${w} x ${h}`);
    }
    render(): void {
      gpu.done = gpu.now + gpu.cost;
    }
    getContext() {
      return {
        SIGNALED: 1,
        getSyncParameter: () => Number(gpu.now >= gpu.done),
        fenceSync: () => ({}),
        deleteSync: () => {},
        flush: () => {},
      };
    }
  },
}));

useFakePage();
const box = { clientWidth: 400, clientHeight: 200 };
let boxChanged: () => void;
let screenChanged: () => void;
let aspects: number[];

function open(canvas = new FakeElement()): Painter {
  aspects = [];
  const painter = new Painter(canvas as unknown as HTMLCanvasElement, box as HTMLElement, (aspect) =>
    aspects.push(aspect),
  );
  painter.resize();
  return painter;
}
const draw = (p: Painter, since: number | null = null): void =>
  p.draw({} as Scene, {} as Camera, gpu.now, since);

beforeEach(() => {
  Object.assign(gpu, { works: true, software: false, now: 1, cost: 0, done: 0, ratio: 0, sizes: [] });
  Object.assign(box, { clientWidth: 400, clientHeight: 200 });
  vi.stubGlobal("devicePixelRatio", 1);
  vi.stubGlobal("matchMedia", (query: string) => ({
    addEventListener: (_: string, then: () => void) => {
      expect(query).toBe(`(resolution: ${devicePixelRatio}dppx)`);
      screenChanged = then;
    },
  }));
  vi.stubGlobal(
    "ResizeObserver",
    class {
      constructor(then: () => void) {
        boxChanged = then;
      }
      observe(): void {}
    },
  );
});

describe("the painter", () => {
  it("resizes with the next picture alone", () => {
    const painter = open();
    draw(painter);
    draw(painter);
    expect(gpu.sizes).toEqual(["400 x 200"]);
    box.clientWidth = 500;
    boxChanged();
    box.clientWidth = 600;
    boxChanged();
    expect(gpu.sizes).toEqual(["400 x 200"]); // the last picture is still shown
    expect(aspects).toEqual([2, 2.5, 3]);
    draw(painter);
    expect(gpu.sizes).toEqual(["400 x 200", "600 x 200"]);
  });

  it("is as fine as the present screen", () => {
    const painter = open();
    draw(painter);
    for (const ratio of [2, 1.5]) {
      vi.stubGlobal("devicePixelRatio", ratio);
      screenChanged();
      draw(painter);
      expect(gpu.ratio).toBe(ratio);
    }
  });

  it("wants a picture of another fineness", () => {
    const painter = open();
    for (let i = 0; i < 24; i++) draw(painter, 0.06);
    expect(aspects).toEqual([2, 2]);
    draw(painter, 0.06);
    expect(gpu.ratio).toBe(0.75);
  });

  it("says that WebGL is off", () => {
    gpu.works = false;
    expect(() => open()).toThrow(NoWebGl);
  });
});

describe("the painter without a graphics card", () => {
  /** Animation frames at 60 Hz, early and late by turns, for this time, s. Returns the number of pictures. */
  function animate(painter: Painter, seconds: number): number {
    const before = painter.pictures;
    let last: number | null = null;
    for (let i = 1; i <= 60 * seconds; i++) {
      gpu.now = 1 + i / 60 + 0.0005 * ((i % 7) - 3);
      if (!painter.ready(gpu.now)) continue;
      draw(painter, last === null ? null : gpu.now - last);
      last = gpu.now;
    }
    return painter.pictures - before;
  }

  beforeEach(() => {
    gpu.software = true;
  });

  it("draws 20 cheap pictures per second", () => {
    gpu.cost = 0.015;
    expect(animate(open(), 30)).toBeGreaterThanOrEqual(590);
    expect(aspects).toEqual([2]); // no other fineness was tried
  });

  it("is coarser for costly pictures", () => {
    gpu.cost = 0.06;
    animate(open(), 4);
    expect(gpu.ratio).toBeLessThan(1);
  });

  it("goes on at once in a page seen again", () => {
    const painter = open();
    draw(painter);
    gpu.now += 60;
    expect(painter.ready(gpu.now)).toBe(false);
    expect(painter.ready(gpu.now + 0.5)).toBe(true);
  });

  it("goes on at once with a new context", () => {
    const canvas = new FakeElement();
    const painter = open(canvas);
    draw(painter);
    canvas.dispatch("webglcontextlost");
    canvas.dispatch("webglcontextrestored");
    expect(painter.ready(gpu.now + 0.3)).toBe(true);
  });
});
