// The numbers beside the picture.
import { COLOURS, Plot } from "./plots.js";

const byId = (id) => document.getElementById(id);
const counted = (count, word) => `${count} ${word}${count === 1 ? "" : "s"}`;
const megabytes = (bytes) => `${(bytes / 1e6).toFixed(1)} MB`;
const css = ([red, green, blue]) => `rgb(${red} ${green} ${blue})`;

/** The stream's faults in a user's words; the keys are those of status_t. */
const FAULTS = { zero: "empty", stuck: "repeated", noise: "noise", wrong_size: "of another size", delayed: "late",
  broken: "broken", slow: "too few a second" };

/** "5: 4 empty, 1 repeated" */
function badFrames(status) {
  const parts = Object.entries(FAULTS).filter(([fault]) => fault !== "slow" && status[`${fault}_frames`] > 0)
    .map(([fault, word]) => `${status[`${fault}_frames`]} ${word}`);
  return parts.length > 0 ? `${status.bad_frames}: ${parts.join(", ")}` : String(status.bad_frames);
}

/** "streaming", "stalled", "streaming, frames empty" */
function device(status) {
  const text = document.createElement("span");
  const fault = FAULTS[status.stream_fault];
  text.textContent = fault ? `${status.device}, frames ${fault}` : status.device;
  if (fault || !["streaming", "opening", "ended"].includes(status.device)) text.className = "bad";
  return text;
}

function row(name, value, wide) {
  const line = document.createElement("tr");
  if (wide) line.className = "wide";
  for (const text of [name, value]) {
    const cell = document.createElement("td");
    cell.append(text);
    line.append(cell);
  }
  return line;
}

function swatch(colour) {
  const box = document.createElement("span");
  box.className = "swatch";
  box.style.background = colour;
  return box;
}

export class Panel {
  constructor() {
    this.plots = { rate: new Plot(byId("plot-rate")), latency: new Plot(byId("plot-latency")),
      stages: new Plot(byId("plot-stages")) };
    this.frames = [];
  }

  setState(word) {
    byId("state").textContent = word;
    byId("state").dataset.state = word;
  }

  setFrame(frame, model) {
    const now = performance.now();
    this.frames.push(now);
    while (this.frames[0] < now - 2000) this.frames.shift();
    this.setState(frame.state);
    byId("frame").textContent = `frame ${frame.frame}`;
    this.last = frame;
    if (!this.frameTime || now - this.frameTime > 200) { // readable
      this.frameTime = now;
      this.showFrame(model);
    }
  }

  /** `note`: what the picture lacks, empty when nothing. */
  showFrame(model, note = this.note ?? "") {
    this.note = note;
    if (!this.last) return;
    const { last: frame } = this;
    const regions = byId("regions");
    regions.replaceChildren(...frame.regions.map((region) => {
      const name = document.createElement("span");
      if (model) name.append(swatch(css(model.palette[region.id + 2] ?? model.palette[2])));
      name.append(region.id === 0 ? "base" : `region ${region.id}`);
      return row(name, `${counted(region.points, "point")}, rms ${(1000 * region.rms).toFixed(2)} mm`);
    }));
    if (frame.regions.length === 0) regions.replaceChildren(row("none", ""));
    const legend = byId("legend");
    if (!model || frame.state !== "tracking") { legend.replaceChildren(); return; }
    const bar = document.createElement("div");
    bar.className = "bar";
    bar.style.background = `linear-gradient(90deg, ${model.displacement.map(css).join(",")})`;
    const ends = document.createElement("div");
    ends.className = "ends";
    for (const text of ["0", `${+(1000 * frame.scale).toPrecision(2)} mm`]) {
      const end = document.createElement("span");
      end.textContent = text;
      ends.append(end);
    }
    const unseen = document.createElement("div");
    unseen.append(swatch(css(model.palette[0])), `${counted(frame.not_observed, "point")} not seen`);
    const lacking = document.createElement("div");
    lacking.className = "lacking";
    lacking.textContent = note;
    legend.replaceChildren(`${counted(frame.deformed, "point")} deformed, by displacement`, bar, ends, unseen, lacking);
  }

  setStatus(status, now) {
    this.status = status;
    this.plots.rate.add(now, { rate: status.rate });
    this.plots.latency.add(now, { median: status.latency_median / 1000, p99: status.latency_p99 / 1000 });
    const stages = {};
    for (const stage of status.stages) stages[stage.name] = stage.median / 1000;
    this.plots.stages.add(now, stages);
    byId("rate-now").textContent = status.rate.toFixed(1);
    byId("latency-now").replaceChildren(`${(status.latency_median / 1000).toFixed(1)} `, swatch(COLOURS[0]), "p99 ",
      `${(status.latency_p99 / 1000).toFixed(1)} `, swatch(COLOURS[1]));
    byId("stage-key").replaceChildren(...this.plots.stages.names().map((name, index) => {
      const entry = document.createElement("span");
      entry.append(swatch(COLOURS[index % COLOURS.length]), name);
      return entry;
    }));
    byId("about").textContent = `Pliant ${status.version}, ${status.source}`;
  }

  /** Once a second, and when something arrived that is read as a number. */
  tick(now, link) {
    const status = this.status;
    if (status) {
      const rows = [
        row("device", device(status)),
        row("confidence", this.last?.confidence.toFixed(2) ?? "–"),
        row("strain energy", status.strain_energy.toFixed(3)),
        row("tracked / searching / lost", `${status.tracked} / ${status.searching} / ${status.lost}`),
        row("bad frames", badFrames(status)),
        row("dropped / over budget", `${status.dropped} / ${status.deadline_misses}`),
        row("unsent / refused", `${status.unsent} / ${status.send_failures}`),
        row("memory", megabytes(status.rss_bytes)),
        row("shown here", `${(this.shown(performance.now())).toFixed(0)} frames/s`),
      ];
      if (status.slow_frames > 0) rows.push(row("frames at too low a rate", String(status.slow_frames)));
      if (status.stalls + status.reopenings > 0)
        rows.push(row("stalls / opened again", `${status.stalls} / ${status.reopenings}`));
      if (status.heap_calls + status.page_faults > 0)
        rows.push(row("heap calls / page faults", `${status.heap_calls} / ${status.page_faults}`));
      if (link?.incomplete) rows.push(row("incomplete on the way", String(link.incomplete)));
      if (status.last_error) rows.push(row("last error", status.last_error, true));
      byId("numbers").replaceChildren(...(status.source.startsWith("capture of ") ? this.captureRows(status) : rows));
    }
    byId("advice").textContent = link?.advice ?? "";
    for (const plot of Object.values(this.plots)) plot.draw(now);
  }

  /** While a model is captured: what the person who shows the object is told, a line for each sentence. */
  captureRows(status) {
    const told = status.last_error.split(/; | \| /).map((sentence) => {
      const line = row(sentence, "");
      line.lastChild.remove();
      line.firstChild.colSpan = 2;
      Object.assign(line.firstChild.style, { whiteSpace: "normal", textAlign: "left" });
      return line;
    });
    return [row("fused / lost", `${status.tracked} / ${status.lost}`), ...told];
  }

  shown(now) {
    return this.frames.filter((time) => time > now - 2000).length / 2;
  }

  silence() {
    this.setState("silent");
  }
}
