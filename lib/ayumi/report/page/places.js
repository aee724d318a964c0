// Places of the pattern in messages: a key or a phase that a message names by its pointer becomes a
// button that selects it.

import { element, seconds } from "./dom.js";

const pointer = /\/(?:keyframes|phases)(?:\/(?:\d+|keyframes|phases))*\/\d+/g;

/// What a pointer names: its selection, its time, and its words for the author; null if the pattern
/// that the page knows has no such place.
function placeOf({ tracks, keyframes, phases }, at) {
  const index = phases.findIndex((one) => one.pointer === at);
  if (index >= 0) return { kind: "phase", pointer: at, time: phases[index].from, words: `phase ${index + 1}` };
  const frame = keyframes.find((one) => one.pointer === at);
  const key = tracks.flatMap((track) => track.keys).find((one) => one.pointer.startsWith(at + "/"));
  return frame && key ? { kind: "key", pointer: key.pointer, time: frame.time, words: `the key at ${seconds(frame.time)}` } : null;
}

/// The words of a message with a button for each place in them.
export function linked(page, words) {
  if (!page.state.replay) return [words];
  const parts = [];
  let from = 0;
  for (const found of words.matchAll(pointer)) {
    const place = placeOf(page.state, found[0]);
    if (!place) continue;
    parts.push(words.slice(from, found.index), element("button", { type: "button", class: "place", title: found[0],
      onclick: () => page.select({ kind: place.kind, pointer: place.pointer }, place.time) }, place.words));
    from = found.index + found[0].length;
  }
  return [...parts, words.slice(from)];
}
