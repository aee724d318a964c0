// node author_bench.mjs AYUMI CHROMEDRIVER PATTERN [SAVES]: changes one value of the pattern, saves it,
// and measures three times from the save: until `ayumi author` has the findings, until the page has
// received them, and until headless Chromium shows the picture. For comparison, it also measures a
// whole `ayumi check` of the same file. Works on a copy. The browser draws without a graphics card: if
// other programs use the processor cores, its next frame may come seconds after the page has received
// the motion.

import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { startDriver, until, wait } from "../report/driver.mjs";

const [ayumi, chromedriver, pattern, saves = "20"] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "author_bench_"));
const file = join(folder, "pattern.json");
const original = readFileSync(pattern, "utf8");

/// The first swing is lifted a little higher, so that its samples change and all are solved again.
function save(i) {
  const changed = original.replace(/("lift": *)([0-9.]+)/,
    (_, name, lift) => name + (Number(lift) + 1e-5 * i).toFixed(5));
  if (i > 0 && changed === original) throw new Error(pattern + ": no \"lift\" with a number to change");
  writeFileSync(file + ".new", changed);
  renameSync(file + ".new", file);
}

const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];
const row = (name, values) => console.log(
  `${name.padEnd(24)} median ${median(values).toFixed(0)} ms, most ${Math.max(...values).toFixed(0)} ms`);

save(0);
const server = spawn(ayumi, ["author", file], { stdio: ["ignore", "pipe", "inherit"] });
const address = await new Promise((resolve, reject) => {
  server.stdout.on("data", (words) => {
    const found = /http:\/\/127\.0\.0\.1:\d+\/\S*/.exec(String(words));
    if (found) resolve(found[0]);
  });
  server.on("exit", () => reject(new Error("the server ended")));
});
const driver = await startDriver(chromedriver);
try {
  const tab = await driver.open("1280,800");
  await tab.load(address);
  await until(() => tab.run("return document.documentElement.dataset.author === 'ready'"), 60);
  // When the next frame begins, the frame with the new version has been drawn and is on the screen.
  await tab.run(`window.shown = {}; window.taken = {};
    new MutationObserver(() => {
      const version = document.documentElement.dataset.version;
      window.taken[version] = Date.now();
      requestAnimationFrame(() => requestAnimationFrame(() => { window.shown[version] = Date.now(); }));
    }).observe(document.documentElement, { attributeFilter: ["data-version"] });`);
  const state = async () => (await fetch(address + "state")).json();
  const findings = [], taken = [], picture = [], check = [];
  for (let i = 1; i <= Number(saves); ++i) {
    const { version } = await state();
    await wait(300);
    const begin = Date.now();
    save(i);
    let now = await state();
    for (; now.version === version; now = await state()) await wait(2);
    findings.push(Date.now() - begin);
    const at = await until(() => tab.run(`return window.shown[${now.version}]`));
    if (!at) throw new Error("the page shows no new version");
    taken.push(await tab.run(`return window.taken[${now.version}]`) - begin);
    picture.push(at - begin);
    const checked = Date.now();
    try {
      execFileSync(ayumi, ["check", file, "-q"], { stdio: "ignore" });
    } catch (error) {
      if (error.status !== 1) throw error;
    }
    check.push(Date.now() - checked);
  }
  console.log(`${(await state()).duration.toFixed(1)} s of motion, ${saves} saves`);
  row("save to findings", findings);
  row("save to page", taken);
  row("save to picture", picture);
  row("check, whole process", check);
  console.log(`findings / check         ${(median(findings) / median(check)).toFixed(2)}`);
  await tab.end();
} finally {
  driver.end();
  server.kill("SIGINT");
  rmSync(folder, { recursive: true });
}
