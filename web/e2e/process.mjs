// SPDX-License-Identifier: Apache-2.0
// Programs that tests start.

import { spawn } from "node:child_process";

/**
 * Starts a program with `env` in addition to the environment. `ready` gets what it has printed and gives something true
 * once the program can be used, which is the result's `found`. `output` collects what it prints.
 */
export async function launch(command, args, { env = {}, ready = () => true } = {}) {
  const child = spawn(command, args, {
    stdio: ["ignore", "pipe", "pipe"],
    env: { ...process.env, PATH: `${process.env.PATH}:/usr/sbin`, ...env },
  });
  const output = { out: "", err: "" };
  const ended = new Promise((resolve) => {
    child.on("exit", resolve);
    child.on("error", resolve);
  });
  const found = await new Promise((resolve, reject) => {
    const collect = (part) => (data) => {
      output[part] += data;
      const found = ready(output.out);
      if (found) resolve(found);
    };
    child.stdout.on("data", collect("out"));
    child.stderr.on("data", collect("err"));
    child.on("spawn", () => ready("") && resolve(true));
    void ended.then((code) => reject(new Error(`${command} ended (${code}): ${output.err}`)));
  });
  return {
    pid: child.pid,
    output,
    found,
    ended,
    /** Ends it; gives its exit status. */
    end(signal = "SIGTERM") {
      child.kill(signal);
      return ended;
    },
  };
}
