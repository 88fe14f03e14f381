// SPDX-License-Identifier: Apache-2.0
import { afterEach, expect, it, vi } from "vitest";
import { fromAddress } from "./fetch";

afterEach(() => vi.unstubAllGlobals());

it("gives up a server that stops answering", async () => {
  const limit = new AbortController();
  const timeout = vi.spyOn(AbortSignal, "timeout").mockReturnValue(limit.signal);
  vi.stubGlobal("fetch", (_: URL, { signal }: { signal?: AbortSignal }) => {
    return new Promise((_, reject) => signal?.addEventListener("abort", () => reject(signal.reason)));
  });
  const file = fromAddress(new URL("https://example.org/me.vrm"));
  limit.abort(new Error("too long"));
  await expect(file).rejects.toThrow("too long");
  expect(timeout.mock.calls[0]![0]).toBeGreaterThan(60_000);
});
