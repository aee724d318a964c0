// node sweep_browser.mjs CHROMEDRIVER PAGE.html: loads the page of a study in headless Chromium and
// tries it as a person would. Prints one line per broken expectation, then "ok" or "failed".

import { pathToFileURL } from "node:url";
import { startDriver, until } from "../report/driver.mjs";

const [driver, page] = process.argv.slice(2);
let failures = 0;
const expect = (good, words) => {
  if (good) return;
  ++failures;
  console.log("broken: " + words);
};

let browser;
try {
  browser = await startDriver(driver);
  for (const [width, height] of [[1280, 900], [390, 844]]) {
    const tab = await browser.open(`${width},${height}`);
    await tab.tool("Emulation.setDeviceMetricsOverride",
      { width, height, deviceScaleFactor: 1, mobile: width < 500 });
    await tab.load(pathToFileURL(page).href);
    const wide = await tab.run("return document.documentElement.scrollWidth");
    expect(wide <= width, `the page is ${wide} wide on a screen of ${width}`);

    // A click sorts by a column of numbers, and Enter sorts the other way round.
    const column = (act) => tab.run(`
      const table = [...document.querySelectorAll("table")]
        .find((each) => each.caption && /worst cases/.test(each.caption.textContent));
      const heads = [...table.querySelectorAll("th[scope=col]")];
      const k = heads.findIndex((head) => head.textContent === "max_cog_error_m");
      ${act}
      return { sort: heads[k].getAttribute("aria-sort"),
        values: [...table.rows].slice(1).map((row) => Number(row.cells[k].textContent)) };`);
    const rising = (values) => values.every((value, i) => i === 0 || value >= values[i - 1]);
    const up = await column("heads[k].click();");
    expect(up.sort === "ascending" && up.values.length > 4 && rising(up.values),
      "sorted up: " + up.values.join(" "));
    const down = await column(
      "heads[k].dispatchEvent(new KeyboardEvent('keydown', { key: 'Enter' }));");
    expect(down.sort === "descending" && rising(down.values.slice().reverse()),
      "sorted down: " + down.values.join(" "));

    const maps = await tab.run(`return [...document.querySelectorAll(".maps table")]
      .map((map) => [map.caption.textContent, map.querySelectorAll("td[style]").length])`);
    expect(maps.some(([what, cells]) => /Failure rate/.test(what) && cells > 3),
      "maps: " + JSON.stringify(maps));
    const intervals = await tab.run(`return [...document.querySelectorAll("#rates td")]
      .filter((cell) => / to /.test(cell.textContent)).length`);
    expect(intervals > 1, "rates with intervals: " + intervals);

    // The replay runs in its frame. The frame is a page of another origin, so its document is read
    // through the driver.
    await tab.run("document.querySelector('details.replay').open = true");
    const ready = await until(() => tab.inFrame("iframe",
      "return document.documentElement.dataset.replay"), 30);
    expect(ready === "ready" || ready === "none", "the replay says " + ready);
    const triangles = await tab.inFrame("iframe", `
      const bytes = Uint8Array.from(atob(document.getElementById("replay-model").textContent.trim()),
        (letter) => letter.charCodeAt(0));
      const length = new DataView(bytes.buffer).getUint32(12, true);
      const model = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length)));
      return (model.meshes || []).flatMap((mesh) => mesh.primitives)
        .reduce((sum, part) => sum + model.accessors[part.indices].count / 3, 0)`);
    expect(triangles > 1000, "the robot of the replay has " + triangles + " triangles");
    const errors = (await tab.log("browser")).filter((entry) => entry.level === "SEVERE");
    expect(errors.length === 0, "messages: " + JSON.stringify(errors));
    await tab.end();
  }
} catch (error) {
  expect(false, error.message);
}
browser?.end();
console.log(failures ? "failed" : "ok");
process.exit(failures ? 1 : 0);
