// The window of time that the timeline, the strip and the curves show together. Places are shares of
// the width, from 0 at the left to 1 at the right.

const shortest = 0.05;  // [s] shortest time that the window shows

export class TimeAxis {
  constructor(duration = 1) {
    this.duration = duration;
    this.from = 0;
    this.to = duration;
  }

  /// Takes over another duration. A window that shows the whole still shows the whole; a part keeps
  /// its place as far as possible.
  stretch(duration) {
    const whole = this.from <= 0 && this.to >= this.duration;
    this.duration = Math.max(shortest, duration);
    if (whole) this.show(0, this.duration);
    else this.show(this.from, this.to);
  }

  show(from, to) {
    const span = Math.min(this.duration, Math.max(shortest, to - from));
    this.from = Math.min(Math.max(0, from), this.duration - span);
    this.to = this.from + span;
  }

  zoom(factor, about) {
    this.show(about - (about - this.from) / factor, about + (this.to - about) / factor);
  }

  /// Moves the window so that t is in it.
  reveal(t) {
    const span = this.to - this.from;
    if (t < this.from || t > this.to) this.show(t - span / 2, t + span / 2);
  }

  shareOf(t) {
    return (t - this.from) / (this.to - this.from);
  }

  timeOf(share) {
    return this.from + share * (this.to - this.from);
  }

  /// Round times in the window, `most` at most.
  ticks(most) {
    const rough = (this.to - this.from) / Math.max(1, most);
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough * (1 - 1e-9));
    const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    const times = [];
    for (let k = Math.ceil(this.from / step - 1e-9); k * step <= this.to + 1e-9; ++k)
      times.push({ time: k * step, text: (k * step).toFixed(digits) });
    return times;
  }
}

/// The nearest of `candidates` if one is within `tolerance` of t, otherwise t.
export function snapped(t, candidates, tolerance) {
  let best = t, distance = tolerance;
  for (const candidate of candidates)
    if (Math.abs(candidate - t) <= distance) {
      best = candidate;
      distance = Math.abs(candidate - t);
    }
  return best;
}
