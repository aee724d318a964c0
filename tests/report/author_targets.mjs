// node author_targets.mjs CHROMEDRIVER PATTERN [SHOTS] -- SERVER ARGUMENTS...: as author_browser.mjs, with a long pattern of a robot with
// many joints whose hands and gaze have targets: they are seen, dragged and typed, a keyframe is mirrored, two pages show the same, and the
// last of a hundred quick saves is shown.

import { conclude, data, driver, expect, openPage, quiet, runTrials, save, shots, text } from "./author_page.mjs";
import { startDriver, until, wait } from "./driver.mjs";

const near = (a, b, most) => Math.abs(a - b) <= most;
const page = "const page = window.ayumiAuthor.page;";
const press = (tab, words) => tab.run(`const found = [...document.querySelectorAll("#selected button")].find((b) => b.textContent === arguments[0]);
  if (found) found.click();
  return Boolean(found);`, words);
const frameAt = (t) => data().keyframes.find((frame) => near(frame.t, t, 1e-6));

async function showsTargets(tab) {
  const frames = data().keyframes;
  const wanted = frames.reduce((n, frame) => n + Object.values(frame.hands ?? {}).filter((one) => one !== "free").length +
    (frame.gaze && frame.gaze !== "free" ? 1 : 0), 0);
  const seen = await tab.run(`${page} page.show(2);
    return { joints: page.state.joints.length, duration: page.state.duration, targets: page.state.targets.length,
      drawn: page.handles.targets.filter((one) => one.ball.visible).length,
      tracks: page.state.tracks.map((one) => one.name), verdict: document.getElementById("verdict").textContent,
      box: document.getElementById("mark-targets").parentElement.hidden };`);
  expect(seen.joints === 44 && near(seen.duration, 60, 1e-6), `${seen.joints} joints, ${seen.duration} s`);
  expect(seen.targets === wanted && seen.drawn === wanted, `${seen.targets} targets, ${seen.drawn} drawn, not ${wanted}`);
  expect(seen.tracks.includes("left hand") && seen.tracks.includes("gaze"), "tracks: " + seen.tracks);
  expect(seen.verdict === "consistent" && !seen.box, "the verdict: " + seen.verdict);
  await tab.shoot("targets.png");
  await tab.click("#mark-targets");
  expect(await tab.run(`${page} return page.handles.targets.every((one) => !one.ball.visible)`), "without their mark they are not drawn");
  await tab.click("#mark-targets");
}

/// Drags a target in the picture, and the hand itself while a target leads it. The target moves up, and the hand
/// reaches it.
async function dragsTargets(tab) {
  const before = data();
  const at = await tab.run(`${page} page.viewer.look("front"); page.show(0);
    return page.state.targets.findIndex((one) => one.label === "left hand" && Math.abs(one.time - 2) < 1e-6);`);
  const pixel = await tab.run("return window.ayumiAuthor.pixelOfTarget(arguments[0])", at);
  await tab.after(() => tab.drag(pixel, [0, -8]));
  const old = before.keyframes.find((frame) => frame.t === 2).hands.left, now = frameAt(2).hands.left;
  expect(now[2] > old[2] + 0.004 && now[2] < old[2] + 0.1, `the target is dragged up: ${old} to ${now}`);
  expect(near(now[0], old[0], 0.02), `and hardly ahead: ${old} to ${now}`);
  expect(near(await tab.run(`${page} return page.time`), 2, 1e-6), "the page shows the time of the key");
  const reached = await tab.run(`${page} const handle = page.state.handles.find((one) => one.name === "left_hand");
    return page.handles.placeOf(handle, page.row()).toArray();`);
  expect(reached.every((x, i) => near(x, now[i], 1e-3)), `the hand is there: ${reached}`);
  await tab.after(() => tab.click("#undo"));
  expect(text() === JSON.stringify(before, null, 1), "undo gives every byte back");
}

/// Between two keys of the target, a drag of the hand writes a key of the target, not of the joints.
async function dragsWhatFollows(tab) {
  const before = data();
  const hand = await tab.run(`${page} page.show(3); return window.ayumiAuthor.pixelOf("left_hand");`);
  await tab.after(() => tab.drag(hand, [6, 0]));
  const made = frameAt(3);
  expect(Array.isArray(made?.hands?.left) && !made.joints, "a key of the target: " + JSON.stringify(made));
  await tab.after(() => tab.click("#undo"));
  // The gaze.
  const eye = await tab.run(`${page} page.show(3); return window.ayumiAuthor.pixelOf("gaze");`);
  await tab.after(() => tab.drag(eye, [8, 0]));
  expect(Array.isArray(frameAt(3)?.gaze), "a key of the gaze: " + JSON.stringify(frameAt(3)));
  await tab.after(() => tab.click("#undo"));
  expect(text() === JSON.stringify(before, null, 1), "all is as before");
}

/// Values are typed, a target is let go and held again, gets a direction, and a keyframe its mirror image.
async function typesTargets(tab) {
  const before = data(), i = before.keyframes.findIndex((frame) => frame.t === 2);
  const select = () => tab.click(`[data-id="/keyframes/${i}/hands/left"]`);
  await select();
  const named = await tab.run(`return [...document.querySelectorAll("#selected label.value")].map((e) => e.textContent);`);
  expect(["position forward m", "position left m", "position up m"].every((words) => named.includes(words)), "names and units: " + named);
  const wanted = Number((before.keyframes[i].hands.left[2] + 0.01).toFixed(4));
  await tab.after(() => tab.type(`#selected [data-id="/keyframes/${i}/hands/left/2"]`, wanted));
  expect(data().keyframes[i].hands.left[2] === wanted, "a typed place: " + JSON.stringify(data().keyframes[i]));
  await tab.after(() => press(tab, "Also hold its direction"));
  const held = data().keyframes[i].hands.left;
  expect(held.position?.[2] === wanted && near(Math.hypot(...held.direction), 1, 1e-3), "a direction: " + JSON.stringify(held));
  await tab.after(() => tab.click("#undo"));
  await select();
  await tab.after(() => press(tab, "Release it here"));
  expect(data().keyframes[i].hands.left === "free", "free: " + JSON.stringify(data().keyframes[i]));
  await select();
  await tab.after(() => press(tab, "Hold the present place"));
  expect(Array.isArray(data().keyframes[i].hands.left), "held again: " + JSON.stringify(data().keyframes[i]));
  for (let n = 0; n < 3; ++n) await tab.after(() => tab.click("#undo"));
  await select();
  await tab.after(() => press(tab, "Mirror this keyframe"));
  const [was, is] = [before.keyframes[i], data().keyframes[i]];
  expect(!is.hands.left && is.hands.right.every((x, k) => near(x, (k === 1 ? -1 : 1) * was.hands.left[k], 1e-9)), "mirrored: " + JSON.stringify(is));
  expect(near(is.joints.l_elbow, was.joints.r_elbow, 1e-9) && !is.joints.r_elbow, "its joints, too: " + JSON.stringify(is));
  expect(is.cog.y === -was.cog.y && is.t === was.t, "and its COG: " + JSON.stringify(is));
  await tab.after(() => tab.click("#undo"));
  await tab.run(`${page} page.show(5); document.getElementById("key-track").value = "target right_hand";`);
  await tab.after(() => tab.click("#add-key button"));
  expect(Array.isArray(frameAt(5)?.hands?.right), "a new key of the other hand: " + JSON.stringify(frameAt(5)));
  await tab.after(() => tab.click("#undo"));
  expect(text() === JSON.stringify(before, null, 1), "all is as before");
}

/// At 820 px every menu is inside the page and can be used.
async function worksNarrow(tab) {
  await tab.size(820, 1100);
  for (const time of [0, 2]) {
    const menu = await tab.run(`${page} page.show(${time});
      document.getElementById("marks").open = true;
      const box = document.querySelector("#marks > div").getBoundingClientRect();
      const top = document.elementFromPoint(box.left + 12, box.top + 12), low = document.elementFromPoint(box.right - 12, box.bottom - 12);
      return { left: box.left, right: box.right, top: box.top, bottom: box.bottom, wide: document.documentElement.scrollWidth,
        free: [top, low].every((e) => e?.closest("#marks")) };`);
    expect(menu.left >= 0 && menu.right <= 820 && menu.top >= 0 && menu.bottom <= 1100 && menu.wide <= 820, "the marks are inside: " + JSON.stringify(menu));
    expect(menu.free, "nothing lies on the marks");
  }
  await tab.shoot("targets_narrow.png");
  await tab.run("document.getElementById('marks').open = false;");
  await tab.size(1280, 800);
}

async function twoPages(driver_, tab) {
  const other = await openPage(driver_, 820, 1100);
  await other.drawNoMore();
  await tab.after(() => tab.run(`${page} page.edit([{ kind: "set", pointer: "/keyframes/0/cog/y", value: 0.01 }]);`));
  expect(await until(() => other.run(`${page} return page.state.tracks.find((one) => one.name === "cog").keys[0].value.y === 0.01`)), "the other page follows");
  await other.after(() => other.click("#undo"));
  expect(await until(() => tab.run(`${page} return page.state.tracks.find((one) => one.name === "cog").keys[0].value.y !== 0.01`)), "and undoes what this page did");
  const good = data();
  for (let i = 0; i < 100; ++i) {
    save(JSON.stringify({ ...good, name: "save " + i }, null, 1));
    await wait(5);
  }
  for (const one of [tab, other])
    expect(await until(() => one.run(`${page} return page.state.text.includes("save 99")`), 90), "the last of a hundred saves is shown");
  await quiet(other);
  await other.end();
}

/// Trials that behave in the same way on a short motion use its first eleven seconds, because with the whole minute
/// each change is judged for a second.
async function onAShortMotion(tab, trials) {
  const minute = text(), short = JSON.parse(minute);
  short.phases[0].until = 11;
  short.keyframes = short.keyframes.filter((frame) => frame.t <= short.phases[0].until);
  await tab.after(() => save(JSON.stringify(short, null, 1)));
  await runTrials(tab, trials);
  await tab.after(() => save(minute));
  expect(near(await tab.run(`${page} return page.state.duration`), 60, 1e-6), "the whole minute again");
}

let driving;
try {
  driving = await startDriver(driver, shots);
  const tab = await openPage(driving, 1280, 800);
  await runTrials(tab, [showsTargets]);
  await tab.drawNoMore();
  await onAShortMotion(tab, [dragsTargets, dragsWhatFollows, typesTargets]);
  await runTrials(tab, [worksNarrow]);
  await twoPages(driving, tab);
  await quiet(tab);
  await tab.end();
} catch (error) {
  expect(false, error.message);
}
driving?.end();
conclude();
