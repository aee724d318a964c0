// What trials of the live page share: the server, the file, and a page in headless Chromium.

import { spawn } from "node:child_process";
import { readFileSync, renameSync, writeFileSync } from "node:fs";
import { until } from "./driver.mjs";

const cut = process.argv.indexOf("--");
export const [driver, pattern, shots] = process.argv.slice(2, cut);
const [program, ...programArguments] = process.argv.slice(cut + 1);
let failures = 0;
export const expect = (good, words) => {
  if (good) return;
  ++failures;
  console.log("broken: " + words);
};

export const server = spawn(program, programArguments, { stdio: ["ignore", "pipe", "inherit"] });
export const address = await new Promise((resolve, reject) => {
  server.stdout.on("data", (words) => {
    const found = /http:\/\/127\.0\.0\.1:\d+\/\S*/.exec(String(words));
    if (found) resolve(found[0]);
  });
  server.on("exit", () => reject(new Error("the server ended")));
});

export const text = () => readFileSync(pattern, "utf8");
export const save = (words) => {
  writeFileSync(pattern + ".saved", words);
  renameSync(pattern + ".saved", pattern);
};
export const data = () => JSON.parse(text());

/// If nobody looks at the pictures, they have a quarter of the pixels in each direction, with the same layout: a
/// machine without a graphics card draws them in less time.
const deviceScaleFactor = shots ? 1 : 0.25;

/// A page with what the trials need.
export async function openPage(driver_, width, height) {
  const tab = await driver_.open(`${width},${height}`);
  tab.size = (w, h) => tab.tool("Emulation.setDeviceMetricsOverride", { width: w, height: h, deviceScaleFactor, mobile: false });
  /// From here on the robot's parts are placed, but not drawn, which takes most of the time of a machine without a graphics card.
  tab.drawNoMore = async () => {
    if (shots) return;
    await tab.run(`window.ayumiAuthor.page.viewer.renderer.render = (scene, camera) => {
        scene.updateMatrixWorld();
        camera.updateMatrixWorld();
      };`);
  };
  await tab.size(width, height);
  await tab.load(address);
  const state = await until(() => tab.run("return document.documentElement.dataset.author"), 60);
  expect(state === "ready", "the page says " + state);
  /// The version that the page shows, once it shows all of the state that it has.
  tab.version = () => until(() => tab.run(`const page = window.ayumiAuthor.page;
    const shown = Number(document.documentElement.dataset.version);
    return !page.loading && shown === page.state.version ? shown : null;`));
  tab.after = async (doing) => {
    const before = await tab.version();
    await doing();
    const now = await until(async () => (await tab.version()) > before);
    expect(now, "a new version is shown after: " + doing);
  };
  tab.click = (selector) => tab.run(`const e = document.querySelector(${JSON.stringify(selector)});
    e.focus(); e.click();`);
  tab.key = (selector, key, more = {}) => tab.run(`document.querySelector(arguments[0]).dispatchEvent(
    new KeyboardEvent("keydown", { key: arguments[1], bubbles: true, cancelable: true, ...arguments[2] }));`,
  selector, key, more);
  tab.type = (selector, value, event = "change") => tab.run(`const e = document.querySelector(arguments[0]);
    e.focus(); e.value = arguments[1]; e.dispatchEvent(new Event(arguments[2], { bubbles: true })); e.blur();`,
  selector, String(value), event);
  tab.box = (selector) => tab.run(`const b = document.querySelector(arguments[0]).getBoundingClientRect();
    return [b.left + b.width / 2, b.top + b.height / 2, b.width, b.height];`, selector);
  const keys = { Shift: "\uE008" };
  tab.drag = (from, by, held = "") => tab.act([{ type: "pointer", id: "mouse", parameters: { pointerType: "mouse" }, actions: [
    { type: "pointerMove", duration: 0, x: Math.round(from[0]), y: Math.round(from[1]) },
    { type: "pointerDown", button: 0 },
    { type: "pointerMove", duration: 50, x: Math.round(from[0] + by[0] / 2), y: Math.round(from[1] + by[1] / 2) },
    { type: "pointerMove", duration: 50, x: Math.round(from[0] + by[0]), y: Math.round(from[1] + by[1]) },
    { type: "pause", duration: 300 }, { type: "pointerUp", button: 0 }] },
    ...held ? [{ type: "key", id: "keys", actions: [{ type: "keyDown", value: keys[held] },
      ...Array(4).fill({ type: "pause", duration: 0 }), { type: "keyUp", value: keys[held] }] }] : []]);
  return tab;
}

/// Runs one trial after the other. An error in one of them does not stop the others.
export async function runTrials(tab, trials) {
  for (const trial of trials) {
    try {
      await trial(tab);
    } catch (error) {
      expect(false, `${trial.name}: ${error.message}`);
    }
  }
}

/// Nothing in the console, and no request to another place.
export async function quiet(tab) {
  const errors = (await tab.log("browser")).filter((entry) => entry.level === "SEVERE" && !/status of (404|409|422)/.test(entry.message));
  expect(errors.length === 0, "the console: " + errors.map((entry) => entry.message).join(" | "));
  const requests = (await tab.log("performance")).map((entry) => JSON.parse(entry.message).message)
    .filter((m) => m.method === "Network.requestWillBeSent").map((m) => m.params.request.url)
    .filter((url) => !/^(data|blob|about|chrome):/.test(url) && !url.startsWith(address));
  expect(requests.length === 0, "requests: " + requests.join(" "));
}

/// Prints the verdict and ends.
export function conclude() {
  server.kill();
  console.log(failures ? "failed" : "ok");
  process.exit(failures ? 1 : 0);
}
