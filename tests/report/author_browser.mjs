// node author_browser.mjs CHROMEDRIVER PATTERN [SHOTS] -- SERVER ARGUMENTS...: starts the server of the
// live page (it prints the address) on PATTERN, which is JSON without comments, loads the page in headless Chromium and works with it
// as a person would. Prints one line per broken expectation, then "ok" or "failed".

import { conclude, data, driver, expect, openPage, quiet, runTrials, save, server, shots, text } from "./author_page.mjs";
import { startDriver, until, wait } from "./driver.mjs";

const keySelector = (i) => `[data-id="/keyframes/${i}/zmp"]`;

async function looks(tab) {
  const seen = await tab.run(`
    const inside = (id) => { const b = document.getElementById(id).getBoundingClientRect();
      return b.width > 0 && b.height > 0 && b.top >= 0 && b.top + Math.min(b.height, 100) <= innerHeight; };
    return { stage: inside("stage"), curves: inside("curves"), phases: document.querySelectorAll(".phase").length,
      keys: document.querySelectorAll(".key").length, verdict: document.getElementById("verdict").textContent,
      wide: document.documentElement.scrollWidth };`);
  expect(seen.stage && seen.curves, "picture and curves are on one screen: " + JSON.stringify(seen));
  expect(seen.phases === data().phases.length, seen.phases + " phases");
  expect(seen.keys === data().keyframes.length, seen.keys + " keys");
  expect(seen.wide <= 1280, "nothing sticks out: " + seen.wide);
  expect(seen.verdict === "consistent", "the verdict: " + seen.verdict);
  const at = (t) => tab.run(`window.ayumiAuthor.page.show(arguments[0]);
    return { base: window.ayumiAuthor.position(0), time: Number(document.getElementById("scrub").value),
      cursor: document.getElementById("cursor").getBoundingClientRect().left,
      plot: (b => [b.left, b.width])(document.getElementById("ruler").getBoundingClientRect()),
      end: window.ayumiAuthor.page.axis.to };`, t);
  const first = await at(0), later = await at(4);
  expect(Math.hypot(...first.base.map((x, i) => x - later.base[i])) > 0.05, "the robot walks");
  const wanted = later.plot[0] + later.plot[1] * later.time / later.end;
  expect(Math.abs(later.cursor - wanted) < 2, `the cursor is at ${later.cursor}, not ${wanted}`);
  const colors = await tab.run(`
    window.ayumiAuthor.page.viewer.paint();
    const small = document.createElement("canvas");
    small.width = 64; small.height = 36;
    const flat = small.getContext("2d");
    flat.drawImage(document.querySelector("#stage canvas"), 0, 0, 64, 36);
    return new Set(new Uint32Array(flat.getImageData(0, 0, 64, 36).data.buffer)).size;`);
  expect(colors > 100, `the picture has ${colors} colours`);
  await tab.shoot("author.png");
}

async function namesEverything(tab) {
  const unnamed = await tab.run(`
    const named = (e) => e.labels?.length || e.textContent.trim() || e.getAttribute("aria-label");
    return [...document.querySelectorAll("button, input, select, canvas, svg, progress")]
      .filter((e) => !named(e)).map((e) => e.outerHTML.slice(0, 120));`);
  expect(unnamed.length === 0, "without a name: " + unnamed.join(" "));
  const reached = await tab.run(`return [...document.querySelectorAll("button, input, select")]
    .filter((e) => e.getClientRects().length && e.tabIndex < 0 && e.getAttribute("role") !== "tab" &&
      [...(e.closest(".lane") ? document.getElementById("time").querySelectorAll(".lane .plot > button")
        : e.parentElement.querySelectorAll("button"))].filter((other) => other.tabIndex === 0).length !== 1).length;`);
  expect(reached === 0, reached + " controls that the keyboard does not reach");
}

async function editsByKeyboard(tab) {
  const before = data().keyframes[2].t;
  await tab.click(keySelector(2));
  expect(await tab.run("return !document.getElementById('tab-edit').hidden"), "a key opens the Edit panel");
  await tab.after(() => tab.key(keySelector(2), "ArrowRight", { ctrlKey: true }));
  expect(Math.abs(data().keyframes[2].t - before - 0.01) < 1e-9, `Ctrl and arrow: ${data().keyframes[2].t}`);
  await tab.after(() => tab.key("body", "z", { ctrlKey: true }));
  expect(data().keyframes[2].t === before, "undone: " + data().keyframes[2].t);
  await tab.after(() => tab.key("body", "Z", { ctrlKey: true, shiftKey: true }));
  expect(Math.abs(data().keyframes[2].t - before - 0.01) < 1e-9, "redone: " + data().keyframes[2].t);
  await tab.after(() => tab.click("#undo"));
  await tab.click(keySelector(2));
  await tab.key(keySelector(2), "ArrowRight");
  const focus = await tab.run("return document.activeElement.dataset.id");
  expect(focus === "/keyframes/3/zmp", "the arrow key goes to the next key: " + focus);
  await tab.after(() => tab.type('#selected [data-id="/keyframes/3/zmp"]', "center"));
  expect(data().keyframes[3].zmp === "center", "a typed value: " + JSON.stringify(data().keyframes[3]));
  await tab.after(() => tab.click("#undo"));
}

/// Works with real key presses alone: the focus is never lost, and never moves without a key press.
async function keepsTheFocus(tab) {
  const keys = { Tab: "\uE004", Enter: "\uE007", Escape: "\uE00C", Right: "\uE014", Left: "\uE012", Up: "\uE013", Down: "\uE015" };
  const press = (name) => tab.act([{ type: "key", id: "keyboard", actions: ["keyDown", "keyUp"].map((type) => ({ type, value: keys[name] ?? name })) }]);
  const at = () => tab.run(`const e = document.activeElement;
    return e === document.body ? "nothing" : (e.closest("#selected") ? "values: " : e.closest("#time") ? "timeline: " : "") + (e.dataset.id ?? e.id);`);
  await tab.run("document.querySelector(arguments[0]).focus()", keySelector(0));
  await press("Right");
  expect(await at() === "timeline: /keyframes/1/zmp", "an arrow key stays on the timeline: " + await at());
  const head = await tab.run("return document.querySelector('#selected h3').textContent");
  expect(head.endsWith(`at ${data().keyframes[1].t} s`), "and selects: " + head);
  let lanes = 0;
  for (; lanes < 20 && (await at()).startsWith("timeline: /keyframes/"); ++lanes) await press("Up");
  expect((await at()).startsWith("timeline: /phases/"), "an arrow key goes to the lane above: " + await at());
  for (; lanes > 0; --lanes) await press("Down");
  expect(await at() === "timeline: /keyframes/1/zmp", "and back to the same time: " + await at());
  await press("Enter");
  expect((await at()).startsWith("values: /keyframes/1"), "Enter goes to the values: " + await at());
  await press("Escape");
  expect(await at() === "timeline: /keyframes/1/zmp", "Escape goes back: " + await at());
  await tab.run("document.querySelector('[data-id=\"/phases/1\"]').click()");
  const units = await tab.run(`return [...document.querySelectorAll("#selected label")]
    .map((l) => [l.textContent, l.querySelector(".unit")?.textContent.trim()])
    .filter(([words, unit]) => unit && !words.endsWith(" " + unit)).map(([words]) => words);`);
  expect(units.length === 0, "names that run into their units: " + units.join("; "));
  // If a move is undone before it is written, the file stays as it was.
  const written = text();
  await tab.run("document.querySelector(arguments[0]).focus()", keySelector(1));
  await tab.act([{ type: "key", id: "keyboard", actions: [["keyDown", "\uE009"], ["keyDown", keys.Right], ["keyUp", keys.Right],
    ["keyDown", "z"], ["keyUp", "z"], ["keyUp", "\uE009"]].map(([type, value]) => ({ type, value })) }]);
  await wait(900);
  expect(text() === written, "Ctrl+Z takes back a move that is not written");
  // Something that is added gets the focus. If it is removed, the focus stays in the panel.
  const buttonTo = (words) => tab.run("[...document.querySelectorAll('#selected button')].find((b) => b.textContent === arguments[0]).focus()", words);
  await tab.click("#whole");
  await buttonTo("Add a block to the ground");
  await tab.after(() => press("Enter"));
  expect((await at()).startsWith("values: /world/blocks/0/"), "a new block has the focus: " + await at());
  await buttonTo("Remove this block");
  await tab.after(() => press("Enter"));
  expect(/selected|values/.test(await at()), "and gives it to the panel: " + await at());
  for (let i = 0; i < 2; ++i) await tab.after(() => tab.click("#undo"));
  // While a job runs, the button Cancel has the focus. When the job is cancelled, the focus returns to the button that
  // started the job.
  await tab.run("document.getElementById('job-push').focus()");
  await press("Enter");
  expect(await until(async () => await at() === "cancel"), "work that runs has the focus at Cancel: " + await at());
  await press("Enter");
  expect(await until(async () => await at() === "job-push"), "and gives it back: " + await at());
  expect(await until(() => tab.run("return document.getElementById('said').textContent === 'push: cancelled.'")), "the work is cancelled");
}

async function addsPhasesAndKeys(tab) {
  const before = data();
  await tab.click('[data-id="/phases/0"]');
  await tab.run("window.ayumiAuthor.page.show(0.4);");
  const press = (words) => tab.run("[...document.querySelectorAll('#selected button')].find((b) => b.textContent === arguments[0]).click();", words);
  await tab.after(() => press("Cut at the cursor"));
  expect(data().phases.length === before.phases.length + 1 && data().phases[0].until === 0.4 &&
    data().phases[1].until === before.phases[0].until, "a phase is cut: " + JSON.stringify(data().phases.slice(0, 2)));
  await tab.after(() => tab.click("#undo"));
  await tab.run("document.getElementById('to-edit').click(); document.getElementById('key-track').value = 'torso';");
  await tab.after(() => tab.click("#add-key button"));
  expect(data().keyframes[1].t === 0.4 && data().keyframes[1].torso, "a key of the trunk: " + JSON.stringify(data().keyframes[1]));
  await tab.after(() => tab.click("#undo"));
  expect(JSON.stringify(data()) === JSON.stringify(before), "all is as before");
}

/// A key for a foot that is not planned has the place where the foot is, and two further keys hold this place at the
/// beginning and the end of the free phase. A foot that stands or swings gets no key.
async function addsKeysOfFeet(tab) {
  const before = data(), bare = Object.fromEntries(["format", "robot", "units", "profile", "defaults"].filter((name) => before[name] !== undefined).map((name) => [name, before[name]]));
  const add = (side, time) => tab.run(`window.ayumiAuthor.page.show(arguments[1]); document.getElementById("to-edit").click();
    document.getElementById("key-track").value = "foot " + arguments[0] + "_foot"; document.querySelector("#add-key button").click();`, side, time);
  const says = async (words) => expect(await until(() => tab.run("return document.getElementById('said').textContent.includes(arguments[0])", words), 5), "the page says: " + words);
  await add("left", (before.phases[0].until + 1e-3) / 2);
  await says("the left foot carries the robot");
  const swing = before.phases.findIndex((phase) => phase.swing);
  await add(before.phases[swing].swing.foot, (before.phases[swing - 1].until + before.phases[swing].until) / 2);
  await says("A swing leads the " + before.phases[swing].swing.foot + " foot");
  expect(JSON.stringify(data()) === JSON.stringify(before), "nothing is written");
  const later = { ...bare, phases: [{ until: 1.2, support: "both" }, { until: 2.2, support: "right" }, { until: 3.2, support: "both" },
    { until: 4.2, support: "right", swing: { foot: "left", step: {} } }, { until: 5.2, support: "both" }],
    keyframes: [{ t: 0.6, zmp: "center" }, { t: 1.1, zmp: "right" }, { t: 4.3, zmp: "right" }, { t: 4.8, zmp: "center" }] };
  await tab.after(() => save(JSON.stringify(later, null, 1)));
  await add("left", 1.7);
  await says("A swing leads the left foot in this pattern");
  expect(JSON.stringify(data()) === JSON.stringify(later), "nothing is written beside a later swing");
  await tab.after(() => save(JSON.stringify({ ...bare, phases: [{ until: 1.2, support: "both" }, { until: 2.8, support: "left" }, { until: 4.2, support: "both" }],
    keyframes: [{ t: 0.6, zmp: "center" }, { t: 1.1, zmp: "left" }, { t: 2.9, zmp: "left" }, { t: 3.4, zmp: "center" }] }, null, 1)));
  await tab.after(() => add("right", 2));
  const keys = () => data().keyframes.filter((frame) => frame.feet).map((frame) => [frame.t, ...frame.feet.right]);
  expect(keys().map(([t]) => t).join() === "1.2,2,2.8" && new Set(keys().map(([, ...place]) => place.join())).size === 1, "keys where the foot stands: " + JSON.stringify(keys()));
  const selected = await tab.run("return [window.ayumiAuthor.page.selection.pointer, document.activeElement.dataset.id]");
  const i = data().keyframes.findIndex((frame) => frame.t === 2);
  expect(selected[0] === `/keyframes/${i}/feet/right` && selected[1] === selected[0] + "/0", "the new key has the focus: " + selected);
  await tab.after(() => tab.type(`#selected [data-id="/keyframes/${i}/feet/right/2"]`, 0.01));
  expect(keys()[1][3] === 0.01 && keys()[0][3] === 0, "and is raised: " + JSON.stringify(keys()));
  // If the robot cannot carry out the pattern as it is written, a new key has the place of the key before it.
  await tab.after(() => tab.type(`#selected [data-id="/keyframes/${i}/feet/right/2"]`, 2));
  expect(await tab.run("return Boolean(window.ayumiAuthor.page.state.error)"), "out of reach");
  await tab.after(() => add("right", 2.4));
  expect(keys()[2][0] === 2.4 && keys()[2][3] === 2, "a copied key: " + JSON.stringify(keys()));
  await tab.after(() => save(JSON.stringify(before, null, 1)));
}

/// Parameters, blocks of the ground, goals of VIIP and blocks that repeat are made, and this is undone.
async function makesWhatIsNotThere(tab) {
  const before = text();
  const press = (words) => tab.run("[...document.querySelectorAll('#selected button')].find((b) => b.textContent === arguments[0]).click();", words);
  const fill = (id, value) => tab.run("const e = document.querySelector(`#selected [data-id=\"${arguments[0]}\"]`); e.focus(); e.value = arguments[1];", id, String(value));
  await tab.click("#whole");
  await fill("new parameter", "trial");
  await fill("new parameter value", 0.04);
  await tab.after(() => press("New"));
  expect(data().parameters?.trial === 0.04, "a parameter: " + JSON.stringify(data().parameters));
  await tab.after(() => press("Add a block to the ground"));
  expect(data().world?.blocks?.length === 1, "a block: " + JSON.stringify(data().world));
  expect(await tab.run(`return document.querySelector('#selected [data-id="/world/blocks/0/height"]')?.value`) === "0.005", "its height can be typed");
  await tab.after(() => press("Remove this block"));
  expect(!data().world?.blocks, "and removed: " + JSON.stringify(data().world));
  for (let i = 0; i < 3; ++i) await tab.after(() => tab.click("#undo"));
  expect(text() === before, "and all is as before");

  const { phases, keyframes } = data(), last = keyframes.filter(({ t }) => t > 0 && t <= phases[0].until).length;
  await tab.click('[data-id="/phases/0"]');
  await fill("/phases/0 rounds", 3);
  await tab.after(() => press("Repeat"));
  const block = data().phases[0], keys = data().keyframes.find((one) => one.repeat);
  expect(block.repeat === 3 && block.phases.length === 1, "a block of phases: " + JSON.stringify(block));
  expect(!last || (keys?.repeat === 3 && keys.keyframes.length === last), "and of its keys: " + JSON.stringify(keys));
  const later = data().phases.at(-1).until;
  expect(Math.abs(later - phases.at(-1).until - 2 * phases[0].until) < 1e-6, `what comes later comes later: ${later}`);
  await tab.click('[data-id="/phases/0/phases/0"]');
  expect(await tab.run("return !document.querySelector('#selected [data-id=append]')"), "no phase can be added after one that is not the last");
  const shown = await tab.run("const s = window.ayumiAuthor.page.state; return [s.phases.length, s.error?.message ?? '']");
  expect(shown[0] === phases.length + 2 && !shown[1], "the page shows its rounds: " + shown);
  if (last) {
    const first = `[data-id^="${(await tab.run("return window.ayumiAuthor.page.state.keyframes.find((frame) => frame.repeated).pointer"))}/"]`;
    const repeated = text();
    await tab.drag(await tab.box(first), [12, 0]);
    const said = await tab.run("return document.getElementById('said').textContent");
    expect(said.includes("block that repeats") && text() === repeated, "a key of a block says why it does not move: " + said);
  }
  const fixedEnd = '[data-id="/phases/0/phases/0/until"]', block2 = text(), said2 = () => tab.run("return document.getElementById('said').textContent");
  const sayNothing = () => tab.run("document.getElementById('said').textContent = ''");
  await sayNothing();
  await tab.drag(await tab.box(fixedEnd), [12, 0]);
  expect((await said2()).includes("block that repeats") && text() === block2, "an end of a phase in a block says why it does not move: " + await said2());
  await sayNothing();
  await tab.run(`document.querySelector('${fixedEnd}').dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight", ctrlKey: true, bubbles: true }))`);
  expect((await said2()).includes("block that repeats") && text() === block2, "and by keys: " + await said2());
  await tab.after(() => tab.click("#undo"));
  expect(text() === before, "and back");
  await tab.click(`[data-id="/phases/${phases.length - 1}"]`);
  await tab.after(() => press("Repeat"));
  await tab.click(`[data-id="/phases/${phases.length - 1}/phases/0"]`);
  await tab.after(() => press("Add a phase after this one"));
  expect(data().phases.length === phases.length + 1 && data().phases.at(-1).support === "both", "a phase after a block: " + JSON.stringify(data().phases.at(-1)));
  for (let i = 0; i < 2; ++i) await tab.after(() => tab.click("#undo"));
  expect(text() === before, "and back again");

  const full = phases.findIndex(({ until }, i) => keyframes.some(({ t }) => t > (phases[i - 1]?.until ?? 0) + 0.001 && t < until - 0.001));
  if (full >= 0) {
    const goal = `#selected [data-id="/phases/${full} goal"]`, asks = () => tab.run("return Boolean(document.querySelector('#selected [role=status]'))");
    const ask = async () => {
      await tab.click(`[data-id="/phases/${full}"]`);
      await tab.type(goal, "jump");
      expect(await asks(), "the page asks about the keyframes in the phase");
    };
    await ask();
    await tab.type(goal, "none");
    expect(!(await asks()), "the choice can be taken back");
    await ask();
    await tab.run("document.querySelector(`#selected [data-id$='keep the keyframes']`).click();");
    expect(!(await asks()), "the keyframes can be kept");
    await ask();
    await tab.click("#whole");
    await tab.click(`[data-id="/phases/${full}"]`);
    expect(!(await asks()), "the question ends with the selection");
    expect(text() === before, "and nothing is written");
  }

  await tab.click(`[data-id="/phases/${phases.length - 1}"]`);
  await tab.after(() => press("Add a phase after this one"));
  await tab.after(() => tab.type(`#selected [data-id="/phases/${phases.length} goal"]`, "cog"));
  expect(data().phases.at(-1).viip?.cog && !data().phases.at(-1).support, "a goal of VIIP: " + JSON.stringify(data().phases.at(-1)));
  await tab.after(() => tab.type(`#selected [data-id="/phases/${phases.length} goal"]`, "none"));
  expect(data().phases.at(-1).support === "both" && !data().phases.at(-1).viip, "and keys again: " + JSON.stringify(data().phases.at(-1)));
  for (let i = 0; i < 3; ++i) await tab.after(() => tab.click("#undo"));
  expect(text() === before, "and all is as before");
}

/// A height field, motions of the floor, weights, what is uncertain, and disturbances that are no pushes.
async function makesEveryPart(tab) {
  const before = text(), at = (pointer) => `#selected [data-id="${pointer}"]`;
  let made = 0;
  const make = async (how, what, seen) => {
    await tab.after(how);
    made += 1;
    const error = await tab.run("return window.ayumiAuthor.page.state.error?.message ?? ''");
    expect(seen(data()) && !error, `${what}: ${error}`);
  };
  const press = (words) => tab.run("[...document.querySelectorAll('#selected button')].find((b) => b.textContent === arguments[0]).click();", words);
  const submit = (id, value) => tab.run("const e = document.querySelector(`#selected [data-id=\"${arguments[0]}\"]`); e.value = arguments[1]; e.form.requestSubmit();", id, value);
  await tab.click("#whole");
  const toes = await tab.run("return Math.max(...window.ayumiAuthor.page.solesAtStart().map(([x]) => x))");
  expect(toes > 0 && toes < 0.2, `the toes at the start are at ${toes} m`);
  await make(() => press("Add a height field to the ground"), "a height field",
    ({ world }) => world.field.heights.length === 7 && world.field.origin[0] >= toes + 0.02);
  await make(() => press("One more row of nodes to the left"), "more nodes", ({ world }) => world.field.heights[6].length === 8);
  expect((await tab.run("return document.querySelectorAll('#selected table.grid input').length")) === 56, "each node has a number");
  await make(() => tab.type(at("/world/field/heights/3/2"), 0.004), "a height", ({ world }) => world.field.heights[3][2] === 0.004);
  await make(() => press("Remove the height field"), "no field", ({ world }) => !world?.field);
  await make(() => press("Add a motion of the floor at the cursor"), "a motion of the floor", ({ world }) => world.motion[0].shape === "half_sine");
  await make(() => tab.type(at("/world/motion/0/shape"), "sine"), "a sine", ({ world }) => world.motion[0].frequency === 1);
  await make(() => press("Give its shift"), "a shift", ({ world }) => world.motion[0].shift.length === 3);
  await make(() => press("Remove this motion of the floor"), "no motion", ({ world }) => !world?.motion);
  const joint = await tab.run("return window.ayumiAuthor.page.state.joints.at(-1).name");
  await make(() => submit("/repair/weights joint", joint), "a weight of a joint in a repair", ({ repair }) => repair.weights[joint] === 10);
  await make(() => tab.type(at("/repair/weights/" + joint), ""), "no weight", ({ repair }) => repair?.weights?.[joint] === undefined);
  await make(() => submit("new quantity", "friction"), "an uncertain quantity", ({ uncertainty }) => uncertainty.quantities[0].uniform[1] === 0.9);
  await make(() => press("Add an uncertain push"), "an uncertain push", ({ uncertainty }) => uncertainty.pushes[0].size === 0.5);
  await make(() => press("Remove this uncertain push"), "no push", ({ uncertainty }) => !uncertainty.pushes);
  await make(() => press("Remove this uncertain quantity"), "nothing uncertain", ({ uncertainty }) => !uncertainty);
  await tab.click(keySelector(2));
  await make(() => submit("/keyframes/2/weights joint", joint), "a weight from a key on", ({ keyframes }) => keyframes[2].weights[joint] === 10);
  const types = await tab.run("return [...document.getElementById('other-type').options].map((o) => o.value)"), first = data().scenario?.length ?? 0;
  for (const [i, type] of types.entries()) {
    await make(() => tab.run("document.getElementById('other-type').value = arguments[0]; document.getElementById('new-other').requestSubmit();", type), type,
      ({ scenario }) => scenario[first + i].type === type);
    expect(await tab.run("return window.ayumiAuthor.page.selection.pointer") === `/scenario/${first + i}`, "it is selected");
    if (type === "floor") await make(() => press("Give its shift"), "a shift of the floor", ({ scenario }) => scenario[first + i].shift.length === 3);
    if (type === "gain_loss")
      await make(() => tab.type(at(`/scenario/${first + i}/joint`), ""), "all joints", ({ scenario }) => scenario[first + i].joint === undefined);
  }
  for (; made > 0; --made) await tab.after(() => tab.click("#undo"));
  expect(text() === before, "and all is as before");
}

/// Values that are not written can be written, and taken away again: nothing else changes.
async function writesOptionalValues(tab) {
  const before = text(), i = data().phases.findIndex((phase) => phase.swing && phase.swing.lift === undefined);
  const at = (pointer) => `#selected [data-id="${pointer}"]`;
  await tab.click("#whole");
  await tab.after(() => tab.type(at("/defaults/cog_height"), 0.24));
  expect(data().defaults?.cog_height === 0.24, "a COG height of the whole pattern: " + JSON.stringify(data().defaults));
  await tab.after(() => tab.click("#undo"));
  expect(text() === before, "and back");
  await tab.click(keySelector(2));
  await tab.after(() => tab.type(at("/keyframes/2/interpolation"), "linear"));
  expect(data().keyframes[2].interpolation === "linear", "an interpolation: " + JSON.stringify(data().keyframes[2]));
  await tab.after(() => tab.type(at("/keyframes/2/torso/pitch"), 2));
  expect(data().keyframes[2].torso?.pitch === 2, "a pitch of the trunk: " + JSON.stringify(data().keyframes[2]));
  await tab.after(() => tab.click("#undo"));
  await tab.after(() => tab.click("#undo"));
  expect(text() === before, "and back");
  if (i >= 0) {
    await tab.click(`[data-id="/phases/${i}"]`);
    await tab.after(() => tab.type(at(`/phases/${i}/swing/lift`), 0.015));
    expect(data().phases[i].swing.lift === 0.015, "a lift: " + JSON.stringify(data().phases[i]));
    await tab.after(() => tab.type(at(`/phases/${i}/swing/lift`), ""));
    expect(data().phases[i].swing.lift === undefined, "the lift is taken away: " + JSON.stringify(data().phases[i]));
    await tab.after(() => tab.click("#undo"));
    await tab.after(() => tab.click("#undo"));
    expect(text() === before, "and back");
  }
}

/// A new key is selected; a time that is typed for it joins the keyframe that is there, and one
/// beyond its neighbours is refused.
async function movesKeysByTyping(tab) {
  const before = data();
  await tab.run("window.ayumiAuthor.page.show(0.3); document.getElementById('to-edit').click(); document.getElementById('key-track').value = 'torso';");
  await tab.after(() => tab.click("#add-key button"));
  const selected = await tab.run("return window.ayumiAuthor.page.selection.pointer");
  expect(selected === "/keyframes/1/torso", "the new key is selected: " + selected);
  const added = text();
  await tab.type('#selected [data-id="/keyframes/1/t"]', 2.9);
  await wait(200);
  expect(text() === added, "a time beyond the next keyframe is not written");
  await tab.after(() => tab.type('#selected [data-id="/keyframes/1/t"]', before.keyframes[1].t));
  expect(data().keyframes.length === before.keyframes.length && data().keyframes[1].torso, "it joins the keyframe: " + JSON.stringify(data().keyframes.slice(0, 3)));
  await tab.after(() => tab.click("#undo"));
  await tab.after(() => tab.click("#undo"));
  expect(JSON.stringify(data()) === JSON.stringify(before), "all is as before");
}

/// As long as places in the text differ from those of the motion that is shown, the page allows no changes.
async function locksWhatIsOld(tab) {
  const before = data(), wrong = structuredClone(before);
  wrong.keyframes.splice(1, 0, { t: 0, zmp: "left" });
  await tab.click(keySelector(3));
  await tab.after(() => save(JSON.stringify(wrong, null, 1)));
  const seen = await tab.run("const p = window.ayumiAuthor.page; return [Boolean(p.state.error), p.can('edit'), [...document.querySelectorAll('#selected input')].every((e) => e.disabled)]");
  expect(seen[0] && !seen[1] && seen[2], "the fields are locked: " + seen);
  await tab.after(() => save(JSON.stringify(before, null, 1)));
  expect(await tab.run("return window.ayumiAuthor.page.can('edit')"), "and free again");
}

async function dragsInTime(tab) {
  const before = data(), along = await tab.run("return document.getElementById('keys-along').checked");
  expect(along, "keys follow the ends of phases");
  const key = await tab.box(keySelector(1));
  await tab.run("window.ayumiAuthor.page.show(2);");
  await tab.after(() => tab.drag(key, [40, 0]));
  expect(await tab.run("return window.ayumiAuthor.page.time") === 2, "a drag does not move the cursor");
  expect(data().keyframes[1].t > before.keyframes[1].t + 0.1, "a dragged key: " + data().keyframes[1].t);
  await tab.after(() => tab.click("#undo"));
  // A value that is written as an expression stays an expression.
  const words = { ...before, parameters: { lift_off: before.keyframes[1].t }, keyframes: structuredClone(before.keyframes) };
  words.keyframes[1].t = "${lift_off}";
  await tab.after(() => save(JSON.stringify(words, null, 1)));
  await tab.after(() => tab.drag(key, [40, 0]));
  expect(/^\$\{lift_off\} \+ 0\.\d+$/.test(data().keyframes[1].t), "a dragged expression: " + data().keyframes[1].t);
  await tab.after(() => save(JSON.stringify(before, null, 1)));
  const grip = await tab.box('[data-id="/phases/0/until"]');
  await tab.after(() => tab.drag([grip[0], grip[1]], [-30, 0]));
  const now = data();
  expect(now.phases[0].until < before.phases[0].until - 0.1, "a dragged phase: " + now.phases[0].until);
  expect(now.keyframes[2].t === now.phases[0].until, `its key follows: ${now.keyframes[2].t}`);
  await tab.after(() => tab.click("#undo"));
  expect(JSON.stringify(data()) === JSON.stringify(before), "all is as before");
}

async function showsFindings(tab) {
  const good = text();
  const wrong = data(), i = wrong.keyframes.findIndex((frame) => frame.t > 2);
  wrong.keyframes[i].zmp = [0.06, 0.07];
  await tab.after(() => save(JSON.stringify(wrong, null, 1)));
  const seen = await tab.run(`
    const findings = window.ayumiAuthor.page.state.findings;
    const joint = window.ayumiAuthor.page.groups().map((group) => group.worst).find((i) => findings[i].joint);
    document.querySelector('#findings [data-id="answer ' + joint + '"]').click();
    const page = window.ayumiAuthor.page;
    return { count: findings.length, at: findings[joint].at, time: page.time, red: window.ayumiAuthor.wrongBodies(),
      curves: page.curves.chosen, joint: findings[joint].joint, ghost: page.viewer.actors[1].root.visible,
      verdict: document.getElementById("verdict").textContent };`);
  expect(seen.count >= 2 && / error/.test(seen.verdict), "findings: " + JSON.stringify(seen));
  expect(Math.abs(seen.time - seen.at) < 1e-6, `a click goes to the instant: ${seen.time}`);
  expect(seen.red.length > 0, "the limb is red");
  expect(seen.curves.includes("q." + seen.joint), "its curve is shown");
  expect(seen.ghost, "the last consistent motion is the ghost");
  await tab.shoot("finding.png");
  // A finding with the severity info is called "Info", and its colour differs from that of warnings and errors.
  const note = await tab.run(`
    const one = { ...window.ayumiAuthor.page.state.findings[0], severity: "info" };
    const words = window.ayumiAuthor.page.answer.call({ state: { findings: [one] }, showFinding() {} },
      { worst: 0, members: [0], places: one.where, consequences: [] }).textContent;
    const color = (severity) => {
      const mark = document.querySelector(".finding").cloneNode();
      mark.className = "finding " + severity;
      document.getElementById("lane-events").append(mark);
      const found = getComputedStyle(mark).backgroundColor;
      mark.remove();
      return found;
    };
    return [words, color("info"), color("warning"), color("error")];`);
  expect(note[0].startsWith("Info ") && new Set(note).size === 4, "an info: " + note);
  const sole = await tab.run(`
    const page = window.ayumiAuthor.page;
    page.showFinding(page.state.findings.find((one) => one.kind === "support_margin"));
    return page.viewer.marks.outline.material.color.getHex();`);
  expect(sole === 0xd6261f, "the support polygon is red: " + sole);
  await tab.key("body", "n");
  await tab.key("body", "Escape");
  expect(await tab.run("return window.ayumiAuthor.wrongBodies().length") === 0, "Escape ends it");
  // If the text cannot be read, the message names its line, and the old motion is grey.
  await tab.after(() => save(good.replace('"phases"', "phases")));
  const line = good.slice(0, good.indexOf('"phases"')).split("\n").length;
  const told = await tab.run(`document.getElementById("error-go").click();
    const page = window.ayumiAuthor.page;
    return { place: document.getElementById("error-place").textContent, hidden: document.getElementById("error").hidden,
      shown: document.querySelector("#text .wrong")?.textContent, stale: page.state.stale,
      lanes: getComputedStyle(document.getElementById("strip")).filter, grey: page.rig.meshes.every(({ mesh, material }) => mesh.material !== material) };`);
  expect(!told.hidden && told.place === `Line ${line}:`, "the error's line: " + JSON.stringify(told));
  expect(/phases/.test(told.shown), "the line is shown: " + told.shown);
  expect(told.stale && told.grey && told.lanes === "grayscale(1)", "the old motion is grey, and so is its strip: " + told.lanes);
  await tab.shoot("error.png");
  // If the robot cannot do what is written, the page says so, and a place that the message names can be clicked.
  const far = JSON.parse(good);
  far.phases.find((one) => one.swing).swing.to[0] += 0.4;
  await tab.after(() => save(JSON.stringify(far, null, 1)));
  const verdict = await tab.run("return document.getElementById('verdict').textContent");
  expect(verdict === "gives no motion", "a motion that is impossible: " + verdict);
  const led = await tab.run(`const place = document.querySelector("#error button.place"), words = place?.textContent;
    place?.click();
    return words + ": " + document.querySelector("#selected h3")?.textContent;`);
  expect(/^phase (\d+): Phase \1,/.test(led), "a place in the message leads there: " + led);
  await tab.after(() => save(good));
  expect(await tab.run("return document.getElementById('error').hidden"), "the error is gone");
}

async function keepsBothVersions(tab) {
  const before = data();
  // The page does not hear of the change in the file, as if file and page were changed at the same time.
  await tab.run("window.ayumiAuthor.page.load = () => Promise.resolve();");
  const changed = { ...before, name: "changed elsewhere" };
  save(JSON.stringify(changed, null, 1));
  await wait(300);
  const edit = (value) => tab.run(`window.ayumiAuthor.page.edit([{ kind: "set", pointer: "/keyframes/0/zmp", value: arguments[0] }]);`, value);
  await edit("left");
  expect(await until(() => tab.run("return document.getElementById('conflict').open")), "the page asks");
  expect(data().keyframes[0].zmp === before.keyframes[0].zmp, "nothing is overwritten");
  const shown = await tab.run("return [...document.querySelectorAll('#versions .old, #versions .new')].map((e) => e.textContent)");
  expect(shown.some((line) => /left/.test(line)), "the difference is shown: " + shown.join(" | ").slice(0, 300));
  await tab.shoot("conflict.png");
  await tab.run("delete window.ayumiAuthor.page.load; document.querySelector('#conflict button[value=theirs]').click();");
  await until(() => tab.run("return window.ayumiAuthor.page.state.text.includes('changed elsewhere')"));
  expect(data().name === "changed elsewhere" && data().keyframes[0].zmp !== "left", "the file is kept");
  await tab.run("window.ayumiAuthor.page.load = () => Promise.resolve();");
  save(JSON.stringify({ ...changed, name: "changed again" }, null, 1));
  await wait(300);
  await edit("left");
  await until(() => tab.run("return document.getElementById('conflict').open"));
  await tab.run("delete window.ayumiAuthor.page.load; document.querySelector('#conflict button[value=mine]').click();");
  await until(() => data().keyframes[0].zmp === "left");
  expect(data().keyframes[0].zmp === "left", "my version is written");
  save(JSON.stringify(before, null, 1));
  await until(() => tab.run("return window.ayumiAuthor.page.state.text.includes(arguments[0])", before.name));
}

async function poses(tab) {
  await tab.run("window.ayumiAuthor.page.show(2.4); document.getElementById('to-pose').click();");
  const place = () => tab.run("return window.ayumiAuthor.position(window.ayumiAuthor.page.state.handles.find((h) => h.name === 'left_hand').body)");
  const before = await place(), frames = data().keyframes.length;
  const name = await tab.run("return window.ayumiAuthor.page.state.joints.find((j) => /^l_shoulder_pitch/.test(j.name)).name");
  await tab.type(`#joints input[type=number][aria-label^="${name} "]`, 40, "input");
  await until(() => tab.run("return window.ayumiAuthor.page.previewed !== null"));
  const follows = await until(async () =>
    Math.hypot(...(await place()).map((x, i) => x - before[i])) > 0.005);  // once it is painted
  expect(follows, "the arm follows its slider");
  expect(data().keyframes.length === frames, "nothing is written while it is tried");
  await tab.after(() => tab.click("#write-pose"));
  const written = data().keyframes.find((frame) => Math.abs(frame.t - 2.4) < 1e-6);
  expect(Math.abs(written?.joints?.[name] - 40) < 0.1, "a key of the joint: " + JSON.stringify(written));
  await tab.after(() => tab.click("#undo"));
  // The COG is dragged in the picture: the ZMP, which leads it, gets a key.
  await tab.run("window.ayumiAuthor.page.viewer.look('front'); window.ayumiAuthor.page.show(0.6);");
  const [pixel, from] = await tab.run("const p = window.ayumiAuthor.page; return [window.ayumiAuthor.pixelOf('cog'), p.row()[p.columns['cog.y']]]");
  await tab.after(() => tab.drag(pixel, [6, 0]));
  const key = data().keyframes.find((frame) => Array.isArray(frame.zmp) && Math.abs(frame.t - 0.6) < 1e-6);
  expect(key, "a key of the ZMP: " + JSON.stringify(data().keyframes.slice(0, 3)));
  const to = await tab.run("const p = window.ayumiAuthor.page; return p.row()[p.columns['cog.y']]");
  expect(Math.abs(to - from) > 0.001, `the COG is dragged from ${from} to ${to}`);
  await tab.after(() => tab.click("#undo"));
  // A drag straight down in the slanted view moves the COG down, and in no other direction.
  const zmpBefore = JSON.stringify(data().keyframes.map((frame) => frame.zmp).filter(Boolean));
  await tab.run("window.ayumiAuthor.page.viewer.look('iso');");
  await tab.after(async () => tab.drag(await tab.run("return window.ayumiAuthor.pixelOf('cog')"), [1, 4]));
  const lower = data().keyframes.find((frame) => Math.abs(frame.t - 0.6) < 1e-6);
  expect(lower?.cog?.height > 0, "a key of the COG height: " + JSON.stringify(lower));
  expect(JSON.stringify(data().keyframes.map((frame) => frame.zmp).filter(Boolean)) === zmpBefore, "the ZMP keeps its keys");
  await tab.after(() => tab.click("#undo"));
  await dragsAFoot(tab);
}

/// In the slanted view, a drag moves a swinging foot over the ground and keeps its lift; with Shift, it changes the lift
/// and keeps the place. The place can also be typed.
async function dragsAFoot(tab) {
  const before = data(), begins = (i) => i > 0 ? before.phases[i - 1].until : 0;
  const i = before.phases.findIndex((phase, k) => phase.swing && k > 2);
  const { foot } = before.phases[i].swing, time = (begins(i) + before.phases[i].until) / 2;
  await tab.run("window.ayumiAuthor.page.viewer.look('iso'); window.ayumiAuthor.page.show(arguments[0]);", time);
  const pixel = () => tab.run("return window.ayumiAuthor.pixelOf(arguments[0])", foot + "_foot");
  const swing = () => data().phases[i].swing, placeOf = (one) => JSON.stringify(one.to ?? one.step);
  await tab.after(async () => tab.drag(await pixel(), [2, 1]));
  expect(swing().lift === before.phases[i].swing.lift && placeOf(swing()) !== placeOf(before.phases[i].swing),
    "a drag moves a foot over the ground: " + JSON.stringify(swing()));
  await tab.after(() => tab.click("#undo"));
  await tab.after(async () => tab.drag(await pixel(), [5, -3], "Shift"));
  expect(swing().lift > before.phases[i].swing.lift && placeOf(swing()) === placeOf(before.phases[i].swing),
    "with Shift it moves up: " + JSON.stringify(swing()));
  await tab.after(() => tab.click("#undo"));
  await tab.run(`const p = window.ayumiAuthor.page; document.getElementById("handle").value = arguments[0]; p.pose.fillPlace();`, foot + "_foot");
  const x = Number(await tab.run("return document.getElementById('place-x').value"));
  await tab.type("#place-x", (x + 4).toFixed(1), "input");
  await until(() => tab.run("return window.ayumiAuthor.page.previewed !== null"));
  await tab.after(() => tab.click("#write-pose"));
  expect(swing().lift === before.phases[i].swing.lift && placeOf(swing()) !== placeOf(before.phases[i].swing),
    "its place is typed: " + JSON.stringify(swing()));
  await tab.after(() => tab.click("#undo"));
  expect(JSON.stringify(data()) === JSON.stringify(before), "undo gives everything back");
}

async function postures(tab) {
  await tab.run(`document.getElementById("to-postures").click();
    document.getElementById("posture-name").value = "mine";`);
  await tab.after(() => tab.click('#capture button[value="plain"]'));
  expect(data().postures?.mine, "a posture is captured: " + JSON.stringify(data().postures));
  await tab.run("window.ayumiAuthor.page.show(0.71);");
  await tab.after(() => tab.run(`[...document.querySelectorAll("#postures li")].find((li) =>
    li.querySelector(".name").textContent === "mine").querySelector("button").click();`));
  expect(data().keyframes[1].posture === "mine", "it is put on a key: " + JSON.stringify(data().keyframes[1]));
  await tab.after(() => tab.click("#undo"));
  await tab.after(() => tab.click("#undo"));
}

async function pushesTheRobot(tab) {
  const before = data().scenario?.length || 0;
  await tab.run("document.getElementById('to-pushes').click(); window.ayumiAuthor.page.viewer.look('top'); window.ayumiAuthor.page.show(1);");
  await tab.click("#draw-push");
  const box = await tab.box("#stage");
  await tab.after(() => tab.drag(box, [0, -60]));
  const push = data().scenario.at(-1);
  expect(data().scenario.length === before + 1 && push.at === 1 && push.impulse > 0, "a drawn push: " + JSON.stringify(push));
  expect(Math.abs(Math.hypot(...push.direction) - 1) < 0.01 && push.direction[2] === 0, "its direction: " + push.direction);
  await tab.after(() => tab.key(`[data-id="/scenario/${before}"]`, "Delete"));
  expect(data().scenario.length === before, "the Delete key removes it");
  await tab.after(() => tab.click("#undo"));
  await tab.after(() => tab.click("#undo"));
}

async function works(tab) {
  await tab.click("#job-check");
  expect(await until(() => tab.run("return window.ayumiAuthor.page.state.result?.kind === 'check'")), "a check answers");
  await tab.click("#job-push");
  expect(await until(() => tab.run("return !document.getElementById('job').hidden")), "work shows its progress");
  await tab.click("#cancel");
  expect(await until(() => tab.run("return document.getElementById('job').hidden")), "work is cancelled");
  expect(await until(() => tab.run("return /cancelled/.test(document.getElementById('said').textContent)")), "and the page says so");
}

/// A repair is shown as a ghost and can be taken; a run is shown in the pattern's place.
async function showsResults(tab) {
  const good = text(), wrong = data(), i = wrong.keyframes.findIndex((frame) => frame.t > 2);
  wrong.keyframes[i].joints = { l_elbow: -170 };
  await tab.after(() => save(JSON.stringify(wrong, null, 1)));
  await tab.click("#job-repair");
  expect(await until(() => tab.run("const p = window.ayumiAuthor.page; return p.state.result?.kind === 'repair' && p.ghostName() === 'repair' && p.viewer.actors[1].root.visible"), 60),
    "the repaired motion is the ghost");
  await tab.shoot("repair.png");
  await tab.after(() => tab.run("[...document.querySelectorAll('#result button')].find((b) => /Take/.test(b.textContent)).click();"));
  expect(data().correction, "it is taken");
  expect(await tab.run("return document.getElementById('verdict').textContent") === "consistent", "and consistent");
  await tab.after(() => tab.click("#undo"));
  expect(!data().correction, "and given back");
  await tab.after(() => save(good));
  const whole = await tab.run("return window.ayumiAuthor.page.viewer.last");
  await tab.click("#job-simulate");
  expect(await until(() => tab.run("return document.getElementById('which').value === 'closed_loop' && window.ayumiAuthor.page.viewer.last > arguments[0] + 0.5", whole), 60),
    "the run is shown: " + await tab.run("return document.getElementById('which').value"));
  const strip = await tab.run(`const p = window.ayumiAuthor.page, { lanes, dt } = p.strip();
    const { plan } = p.state.strips;
    return [lanes.map((one) => one.name).join() === plan.lanes.map((one) => one.name).join(), dt * lanes[0].values.length, plan.lanes[0].values.length * plan.dt,
      document.querySelector(".of-pattern").textContent];`);
  expect(strip[0] && strip[1] > strip[2] + 0.5 && /strip and curves show: run/.test(strip[3]), "and so is its strip: " + strip);
  // A drag works at once while a run is shown; it shows the pattern again.
  const first = data();
  const hand = await tab.run("window.ayumiAuthor.page.show(2); return window.ayumiAuthor.pixelOf('left_hand')");
  await tab.after(() => tab.drag(hand, [10, -14]));
  expect(JSON.stringify(data()) !== JSON.stringify(first) && await tab.run("return window.ayumiAuthor.page.showsPlan()"), "a drag while a run is shown changes the pattern");
  await tab.after(() => tab.click("#undo"));
  await tab.click("#job-simulate");
  expect(await until(() => tab.run("return document.getElementById('which').value === 'closed_loop'"), 60), "the run is shown");
  // A new key has the value of the pattern, whatever motion is shown.
  const planned = await tab.run("const p = window.ayumiAuthor.page; p.show(1); return p.planRow()[p.plan.columns['q.l_elbow']] * 180 / Math.PI");
  await tab.run("document.getElementById('to-edit').click(); document.getElementById('key-track').value = 'l_elbow';");
  await tab.after(() => tab.click("#add-key button"));
  const made = data().keyframes.find(({ t }) => Math.abs(t - 1) < 1e-6)?.joints?.l_elbow;
  expect(Math.abs(made - planned) < 0.01, `a key with the value of the pattern: ${made}, not ${planned}`);
  await tab.after(() => tab.click("#undo"));
  await tab.click("#job-simulate");
  expect(await until(() => tab.run("return document.getElementById('which').value === 'closed_loop'"), 60), "the run is shown again");
  await tab.after(() => tab.run("window.ayumiAuthor.page.edit([{ kind: 'set', pointer: '/keyframes/0/zmp', value: 'left' }]);"));
  const back = await tab.run("return [document.getElementById('which').value, window.ayumiAuthor.page.viewer.last]");
  expect(back[0] === "plan" && Math.abs(back[1] - whole) < 1e-6, "an edit shows the pattern again: " + back);
  await tab.after(() => tab.click("#undo"));
}

/// What is being typed or tried is not lost when the file changes meanwhile, and stays on its key.
async function keepsWhatIsBeingTyped(tab) {
  const before = data();
  await tab.click(keySelector(4));
  await tab.run(`const e = document.querySelector('#selected [data-id="/keyframes/4/t"]'); e.focus(); e.value = "1.7";`);
  const added = structuredClone(before);
  added.keyframes.splice(1, 0, { t: 0.3, fz: 63 });
  await tab.after(() => save(JSON.stringify(added, null, 1)));
  const after = await tab.run(`return [window.ayumiAuthor.page.selection.pointer, document.querySelector("#selected h3").textContent];`);
  expect(after[0] === "/keyframes/5/zmp" && after[1].includes(String(before.keyframes[4].t)), "the selection stays on its key: " + after);
  await tab.after(() => save(JSON.stringify(before, null, 1)));
  await tab.run(`const e = document.querySelector('#selected [data-id="/keyframes/4/t"]'); e.focus(); e.value = "1.7";`);
  await tab.after(() => save(JSON.stringify({ ...before, name: "other" }, null, 1)));
  const typed = await tab.run("return [document.activeElement.dataset.id, document.activeElement.value]");
  expect(typed[0] === "/keyframes/4/t" && typed[1] === "1.7", "what is typed stays: " + typed);
  await tab.after(() => save(JSON.stringify(before, null, 1)));
}

/// If the server offers few functions, the page shows no control for a missing one, and causes no error.
async function showsNoDeadControls(tab) {
  const seen = await tab.run(`
    const page = window.ayumiAuthor.page, { version, file, text, hash, duration, replay } = page.state;
    return page.take({ version, file, text, hash, duration, replay }).then(() => {
      for (const tab of ["answers", "edit", "pushes", "text"]) document.getElementById("to-" + tab).click();
      return [...document.querySelectorAll("header button, header select, main button, main select, main input")]
        .filter((e) => e.getClientRects().length).map((e) => e.id || e.textContent);
    });`);
  for (const id of ["undo", "redo", "job-check", "job-repair", "job-simulate", "law", "job-push", "job-export",
    "to-pose", "to-postures", "keys-along", "draw-push"])
    expect(!seen.includes(id), `without its feature ${id} is not shown`);
  expect(seen.includes("play") && seen.includes("to-text"), "the rest is there: " + seen.join(" "));
  // A pattern that could not be read from the start has no motion at all.
  const shown = await tab.run(`
    const page = window.ayumiAuthor.page, { version, file, text, hash } = page.state;
    return page.take({ version, file, text, hash, error: { message: "no phases", line: 2 } }).then(() =>
      [document.documentElement.dataset.author, document.getElementById("error").textContent]);`);
  expect(shown[0] === "error" && /Line 2:.*no phases/s.test(shown[1]), "an unreadable start: " + shown);
  await tab.run("return window.ayumiAuthor.page.load();");
  expect(await tab.run("return document.documentElement.dataset.author") === "ready", "and back");
}

/// Two pages on one pattern, and many quick saves.
async function followsTheFile(driver_, tab) {
  const other = await openPage(driver_, 820, 1100);
  await other.shoot("narrow.png");
  expect(await other.run("return document.documentElement.scrollWidth") <= 820, "nothing sticks out at 820 px");
  await other.tool("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: "dark" }] });
  await other.shoot("dark.png");
  const ground = await other.run("return getComputedStyle(document.body).backgroundColor");
  expect(Math.max(...ground.match(/\d+/g).map(Number)) < 60, "the dark page is dark: " + ground);
  await other.drawNoMore();
  await tab.after(() => tab.run("window.ayumiAuthor.page.edit([{ kind: 'set', pointer: '/keyframes/0/zmp', value: 'left' }]);"));
  expect(await until(() => other.run("return window.ayumiAuthor.page.state.tracks[0].keys[0].value === 'left'")), "the other page follows");
  await tab.after(() => tab.click("#undo"));
  const good = data();
  for (let i = 0; i < 100; ++i) {
    save(JSON.stringify({ ...good, name: "save " + i }, null, 1));
    await wait(5);
  }
  for (const one of [tab, other])
    expect(await until(() => one.run("return window.ayumiAuthor.page.state.text.includes('save 99')"), 60), "the last of a hundred saves is shown");
  save(JSON.stringify(good, null, 1));
  await quiet(other);
  await other.end();
}

let driving;
try {
  driving = await startDriver(driver, shots);
  const tab = await openPage(driving, 1280, 800);
  await runTrials(tab, [looks]);
  await tab.drawNoMore();
  await runTrials(tab, [namesEverything, editsByKeyboard, keepsTheFocus, addsPhasesAndKeys, addsKeysOfFeet, makesWhatIsNotThere, makesEveryPart,
    writesOptionalValues, movesKeysByTyping, locksWhatIsOld, dragsInTime, showsFindings, keepsBothVersions,
    poses, postures, pushesTheRobot, works, showsResults, keepsWhatIsBeingTyped, showsNoDeadControls]);
  await followsTheFile(driving, tab);
  await quiet(tab);
  server.kill();
  expect(await until(() => tab.run("return !document.getElementById('lost').hidden")), "the page says that the server is gone");
  await tab.end();
} catch (error) {
  expect(false, error.message);
}
driving?.end();
conclude();
