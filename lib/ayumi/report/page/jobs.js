// Check, repair, simulation, pushes and export: long work of the server, with its progress and its
// results.

import { byId, element, seconds } from "./dom.js";
import { linked } from "./places.js";

const kinds = ["check", "repair", "simulate", "push", "export"];

export class Jobs {
  constructor(page) {
    this.page = page;
    this.running = null;
    for (const kind of kinds)
      byId("job-" + kind).addEventListener("click", () => this.start(kind));
    byId("cancel").addEventListener("click", () => this.cancel());
  }

  async start(kind) {
    const options = kind === "simulate" ? { law: byId("law").value } : {};
    const { status, value } = await this.page.server.ask("POST", "job", { kind, options });
    if (status !== 200) return this.page.say(value.message || `The server cannot start “${kind}”. Please reload the page.`);
    if (this.ended === value.id) return;
    this.running = { id: value.id, kind };
    this.show({ progress: null, text: "" });
  }

  cancel() {
    if (this.running) this.page.server.ask("DELETE", "job/" + this.running.id);
  }

  news(job) {
    if (!job.done) {
      this.running = { id: job.id, kind: job.kind };
      this.show(job);
      return;
    }
    this.ended = job.id;
    if (this.running?.id === job.id) this.running = null;
    this.show(job);
    this.page.say(!job.error ? `${job.kind}: done.` : job.error === "cancelled" ? `${job.kind}: cancelled.`
      : `${job.kind}: ${job.error}`);
  }

  /// A button that is switched off or disappears passes its focus on: from the button that started
  /// the work to Cancel, and back at the end.
  show({ progress, text }) {
    const at = document.activeElement, begun = kinds.find((kind) => at === byId("job-" + kind));
    const within = at === byId("cancel");
    byId("job").hidden = !this.running;
    for (const kind of kinds) byId("job-" + kind).disabled = Boolean(this.running);
    if (this.running && begun) {
      this.begun = begun;
      byId("cancel").focus();
    }
    if (!this.running && within) byId("job-" + (this.begun ?? "check")).focus();
    if (!this.running) return;
    byId("job-words").textContent = this.running.kind + (text ? ": " + text : "");
    const bar = byId("job-progress");
    if (typeof progress === "number") bar.value = progress;
    else bar.removeAttribute("value");
  }

  render() {
    const { result } = this.page.state;
    for (const kind of kinds) byId("job-" + kind).parentElement.hidden = !this.page.can("job." + kind);
    byId("result").hidden = !result;
    if (!result) return;
    byId("result-title").textContent = { check: "Check", repair: "Repair", simulate: "Simulation", push: "Pushes",
      export: "Export" }[result.kind] || result.kind;
    byId("result-lines").replaceChildren(
      element("p", { class: result.good ? "good" : "bad" }, result.verdict || ""),
      ...(result.lines || []).map((line) => element("p", {}, ...linked(this.page, line))),
      ...(result.files || []).map((file) => element("p", {}, element("code", {}, file))),
      ...(result.marks || []).map((mark) => element("p", {}, element("button", { type: "button", class: "line",
        onclick: () => this.page.show(mark.time) }, `${seconds(mark.time)}: ${mark.text}`))),
      ...(result.text && this.page.can("edit") ? [element("button", { type: "button",
        onclick: () => this.page.write(result.text) }, "Take the repaired pattern")] : []));
  }
}
