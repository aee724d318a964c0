// node browser.mjs CHROMEDRIVER PAGE.html: loads the page in headless Chromium and tries it as a
// person would. Prints one line per broken expectation, then "ok" or "failed".

import { pathToFileURL } from "node:url";
import { startDriver, until } from "./driver.mjs";

const [driver, page, shot] = process.argv.slice(2);
const address = pathToFileURL(page).href;
/// If nobody looks at the pictures, they have a quarter of the pixels in each direction, with the
/// same layout: a machine without a graphics card draws them in less time.
const deviceScaleFactor = shot ? 1 : 0.25;
let failures = 0;
const expect = (good, words) => {
  if (good) return;
  ++failures;
  console.log("broken: " + words);
};

async function withScript(tab) {
  await tab.tool("Emulation.setDeviceMetricsOverride", { width: 1100, height: 900, deviceScaleFactor, mobile: false });
  await tab.load(address);
  const state = await until(() => tab.run("return document.documentElement.dataset.replay"), 30);
  expect(state === "ready", "the replay says " + state + ": " +
    await tab.run("return document.getElementById('replay-state').textContent"));
  const at = (t) => tab.run(`
    const scrub = document.getElementById("scrub");
    scrub.value = arguments[0];
    scrub.dispatchEvent(new Event("input"));
    return { time: window.ayumiReplay.time, base: window.ayumiReplay.position(0),
      head: window.ayumiReplay.position(1), said: scrub.getAttribute("aria-valuetext"),
      cursor: Number(document.querySelector(".cursor").getAttribute("x1")),
      axis: document.querySelector("[data-time-axis]").dataset.timeAxis.split(" ").map(Number),
      readout: document.getElementById("readout").textContent };`, t);
  const last = await tab.run("return Number(document.getElementById('scrub').max)");
  const first = await at(0), later = await at(0.6 * last);
  const moved = Math.hypot(...first.base.map((x, i) => x - later.base[i]));
  expect(moved > 0.01, "scrubbing moves the robot, by " + moved + " m");
  for (const now of [first, later]) {
    const [left, right, from, to] = now.axis;
    const x = left + (right - left) * (now.time - from) / (to - from);
    expect(Math.abs(now.cursor - x) < 0.5, "the cursor stands at the time: " + now.cursor);
  }
  expect(later.cursor - first.cursor > 100, "scrubbing moves the cursor");
  expect(/seconds, /.test(later.said), "the scrub bar speaks: " + later.said);
  expect(later.readout.startsWith("t " + later.time.toFixed(3)), "the readout: " + later.readout);
  for (const one of [first, later]) expect(!/-0\.?0*(?![.\d])/.test(one.readout), "no minus before zero: " + one.readout);
  const floors = [0, 0.6 * last].map((t) => `window.ayumiReplay.show(${t}),
    window.ayumiReplay.floor()`);
  const [still, tilted] = await tab.run(`return [(${floors[0]}), (${floors[1]})];`);
  expect(still.height === 0 && still.bumps === 0, "the floor begins level: " + still.height);
  expect(Math.abs(tilted.height - 0.02) < 1e-6 && Math.abs(tilted.turn[0] - Math.sin(0.05)) < 1e-6,
    "the floor moves: " + JSON.stringify(tilted));
  expect(tilted.bumps === 1, "the bump comes up");
  await tab.shoot("replay.png");
  const clicked = await tab.run(`
    const svg = document.querySelector("[data-time-axis] svg");
    const box = svg.getBoundingClientRect();
    svg.dispatchEvent(new PointerEvent("pointerdown", { buttons: 1, bubbles: true,
      clientX: box.left + box.width / 2, clientY: box.top + box.height / 2 }));
    return window.ayumiReplay.time;`);
  expect(Math.abs(clicked - 0.5 * last) < 0.1 * last, "a click in the plot sets the time: " + clicked);
  const stepped = await tab.run(`
    const canvas = document.querySelector("#stage canvas"), before = window.ayumiReplay.time;
    canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight", bubbles: true }));
    return window.ayumiReplay.time - before;`);
  expect(stepped > 0 && stepped < 0.2, "the arrow key steps by " + stepped);
  const colors = await tab.run(`
    const ghost = document.getElementById("ghost");
    ghost.selectedIndex = 1;
    ghost.dispatchEvent(new Event("change"));
    const canvas = document.querySelector("#stage canvas");
    window.ayumiReplay.show(window.ayumiReplay.time);
    const small = document.createElement("canvas");
    small.width = 64; small.height = 36;
    const flat = small.getContext("2d");
    flat.drawImage(canvas, 0, 0, 64, 36);
    return new Set(new Uint32Array(flat.getImageData(0, 0, 64, 36).data.buffer)).size;`);
  expect(colors > 100, "the canvas shows a scene: " + colors + " colours");
  const unnamed = await tab.run(`
    const named = (e) => e.labels?.length || e.textContent.trim() || e.getAttribute("aria-label");
    return [...document.querySelectorAll("button, input, select, canvas")].filter((e) => !named(e))
      .map((e) => e.outerHTML).concat([...document.querySelectorAll("img")].filter((e) => !e.alt)
      .map((e) => "img")).concat([...document.querySelectorAll("svg")].filter((e) =>
      !e.querySelector("title")).map((e) => "svg"));`);
  expect(unnamed.length === 0, "controls and pictures without a name: " + unnamed.join(" "));
  await tab.shoot("ghost.png");
  const errors = await tab.log("browser");
  expect(errors.every((entry) => entry.level !== "SEVERE"),
    "the console: " + errors.map((entry) => entry.message).join(" | "));
  const requests = (await tab.log("performance")).map((entry) => JSON.parse(entry.message).message)
    .filter((m) => m.method === "Network.requestWillBeSent").map((m) => m.params.request.url)
    .filter((url) => !/^(data|blob|about|chrome):/.test(url) && url !== address);
  expect(requests.length === 0, "requests: " + requests.join(" "));
}

/// The places of scene and curves in the window, and the size of the smallest letters of the
/// curves.
const seen = (tab) => tab.run(`
  const box = (e) => { const b = e.getBoundingClientRect();
    return { left: b.left, right: b.right, top: b.top, bottom: b.bottom }; };
  const svgs = [...document.querySelectorAll("#loci svg")].filter((e) => e.getClientRects().length);
  const letters = svgs.flatMap((svg) => [...svg.querySelectorAll("text")].map((text) =>
    Number(text.getAttribute("font-size")) * svg.getBoundingClientRect().width /
      svg.viewBox.baseVal.width));
  const lines = (e) => { const range = document.createRange(); range.selectNodeContents(e);
    return range.getBoundingClientRect(); };
  const sheet = document.querySelector("#snapshots img");
  return { sheet: sheet ? sheet.getBoundingClientRect().width : 1e9, words: Math.max(...[...document.querySelectorAll("caption")].map((e) => lines(e).right)), stage: box(document.getElementById("stage")), curves: box(svgs[0]), plots: svgs.length,
    letters: Math.min(...letters), wide: document.documentElement.scrollWidth,
    window: { width: innerWidth, height: innerHeight } };`);

/// The same page in windows of several sizes: the scene stays in sight while curves are read.
async function inWindows(tab) {
  for (const [width, height] of [[390, 844], [360, 640], [820, 1180], [1280, 800], [1920, 1080]]) {
    const name = width + "x" + height;
    await tab.tool("Emulation.setDeviceMetricsOverride",
      { width, height, deviceScaleFactor, mobile: width < 500 });
    await tab.load(address);
    await until(() => tab.run("return document.documentElement.dataset.replay"), 30);
    const top = await seen(tab);
    expect(top.plots === 2, name + ": one layout of the curves, of " + top.plots + " plots");
    expect(top.letters >= 10.99, name + ": letters of " + top.letters + " pixels");
    expect(top.wide <= width, name + ": the page is " + top.wide + " wide");
    expect(top.sheet >= 640, name + ": the snapshots are " + top.sheet + " wide");
    expect(top.words <= width, name + ": the words above a table end at " + top.words);
    await tab.run("document.querySelectorAll('#loci figure svg').forEach((e) => { " +
      "if (e.getClientRects().length) window.last = e; }); " +
      "scrollTo(0, window.last.getBoundingClientRect().top + scrollY - innerHeight / 2);");
    const below = await seen(tab);
    expect(below.stage.top >= -1 && below.stage.bottom <= below.window.height + 1,
      name + ": beside the last curves the scene is at " + JSON.stringify(below.stage));
    if (width >= 1280) expect(below.stage.right <= below.curves.left, name + ": side by side");
    else expect(below.stage.bottom - below.stage.top < 0.5 * height, name + ": room for curves");
    await tab.shoot("page-" + name + ".png");
    const event = await tab.run(`
      const link = [...document.querySelectorAll("#events [data-time]")].at(-1);
      link.click();
      return { wanted: Number(link.dataset.time), time: window.ayumiReplay.time };`);
    expect(Math.abs(event.wanted - event.time) < 1e-9, name + ": a click on an event leads to " +
      event.time);
    const after = await seen(tab);
    expect(after.stage.top >= -1 && after.stage.top < after.window.height,
      name + ": and the scene is in sight");
  }
  await tab.tool("Emulation.clearDeviceMetricsOverride", {});
}

/// The page without scripts, in the dark colour scheme.
async function withoutScript(tab) {
  await tab.tool("Emulation.setScriptExecutionDisabled", { value: true });
  await tab.tool("Emulation.setEmulatedMedia", { features: [
    { name: "prefers-color-scheme", value: "dark" }] });
  await tab.load(address);
  const replay = await tab.run("return document.documentElement.dataset.replay || 'none'");
  expect(replay === "none", "scripts are held back: " + replay);
  await tab.shoot("dark.png");
  const seen = await tab.run(`
    const visible = (id) => { const e = document.getElementById(id);
      return Boolean(e && e.getClientRects().length); };
    return { verdict: document.querySelector(".verdict").textContent,
      controls: visible("controls"), loci: visible("loci"),
      picture: document.querySelector("#stage img")?.naturalWidth,
      ground: getComputedStyle(document.body).backgroundColor };`).catch((error) => String(error));
  expect(/stands|falls|rest/.test(seen.verdict), "without scripts the verdict: " + seen.verdict);
  expect(!seen.controls, "without scripts the controls are hidden");
  expect(seen.loci && seen.picture > 0, "without scripts plots and picture are there");
  const light = seen.ground.match(/\d+/g).map(Number);
  expect(Math.max(...light) < 60, "the dark page is dark: " + seen.ground);
}

let driving;
try {
  driving = await startDriver(driver, shot);
  const tab = await driving.open();
  await withScript(tab);
  await inWindows(tab);
  await withoutScript(tab);
  await tab.end();
} catch (error) {
  expect(false, error.message);
}
driving?.end();
console.log(failures ? "failed" : "ok");
process.exit(failures ? 1 : 0);
