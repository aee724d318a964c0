// Headless Chromium by its driver, for trials of pages.

import { spawn } from "node:child_process";
import { writeFileSync } from "node:fs";

/// Starts the driver; `open` begins a browser, `end` stops the driver.
export async function startDriver(program, shots) {
  const service = spawn(program, ["--port=0"], { stdio: ["ignore", "pipe", "ignore"] });
  const port = await new Promise((resolve, reject) => {
    service.stdout.on("data", (words) => {
      const found = /successfully on port (\d+)/.exec(String(words));
      if (found) resolve(found[1]);
    });
    service.on("exit", () => reject(new Error("chromedriver ended")));
  });
  const base = `http://127.0.0.1:${port}/session`;
  const call = async (method, path, body) => {
    const answer = await fetch(base + path, { method, body: body && JSON.stringify(body) });
    const { value } = await answer.json();
    if (value && value.error) throw new Error(value.error + ": " + value.message);
    return value;
  };
  const open = async (size = "1100,900") => {
    // Without a graphics card, Chromium composes the page faster by its own software than by an emulated graphics card.
    const args = ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", `--window-size=${size}`,
      "--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--disable-gpu-compositing"];
    const { sessionId } = await call("POST", "", { capabilities: { alwaysMatch: {
      browserName: "chrome", "goog:chromeOptions": { args },
      "goog:loggingPrefs": { browser: "ALL", performance: "ALL" } } } });
    return { run: (script, ...args) => call("POST", `/${sessionId}/execute/sync`, { script, args }),
      inFrame: async (selector, script) => {
        const id = await call("POST", `/${sessionId}/element`, { using: "css selector", value: selector });
        await call("POST", `/${sessionId}/frame`, { id });
        const answer = await call("POST", `/${sessionId}/execute/sync`, { script, args: [] });
        await call("POST", `/${sessionId}/frame`, { id: null });
        return answer;
      },
      load: (url) => call("POST", `/${sessionId}/url`, { url }),
      tool: (cmd, params) => call("POST", `/${sessionId}/goog/cdp/execute`, { cmd, params }),
      act: (actions) => call("POST", `/${sessionId}/actions`, { actions }),
      log: (type) => call("POST", `/${sessionId}/se/log`, { type }),
      end: () => call("DELETE", `/${sessionId}`),
      shoot: async (name) => { if (shots) writeFileSync(shots + name,
        Buffer.from(await call("GET", `/${sessionId}/screenshot`), "base64")); } };
  };
  return { open, end: () => service.kill() };
}

export const wait = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

/// The first answer of `ask` that is true, or the last one after `seconds`.
export async function until(ask, seconds = 20) {
  for (const end = Date.now() + 1000 * seconds; ;) {
    const answer = await ask();
    if (answer || Date.now() > end) return answer;
    await wait(50);
  }
}
