// The page: what arrives is shown, what is missing is said.
import { Connection } from "./connection.js";
import { Panel } from "./panel.js";
import { Scene } from "./scene.js";

const byId = (id) => document.getElementById(id);
const panel = new Panel();
let scene = null;
try {
  scene = new Scene(byId("scene"));
} catch (fault) {
  console.error(fault);
}

let model = null, link = null, connected = false, paused = false, waiting = {}, frameHeard = -1e9, depthHeard = -1e9;

function show(packet) {
  if (packet.kind === "model") {
    model = packet;
    scene?.setModel(packet);
  } else if (packet.kind === "frame") {
    scene?.setFrame(packet);
    panel.setFrame(packet, model);
  } else if (packet.kind === "depth") {
    scene?.setDepth(packet);
  } else if (packet.kind === "status") {
    panel.setStatus(packet, performance.now());
  }
}

const connection = new Connection(
  (packet) => {
    if (packet.kind === "link") link = packet;
    if (packet.kind === "frame") frameHeard = performance.now();
    if (packet.kind === "depth") depthHeard = performance.now();
    // While paused the newest of each is kept, so that going on shows the present.
    if (packet.kind !== "link") {
      if (paused) waiting[packet.kind] = packet;
      else show(packet);
    }
    if (packet.kind === "link" || packet.kind === "status") refresh();
  },
  (state) => { connected = state; refresh(); },
  () => (scene?.showDepth && !paused ? "next depth" : "next"),
);

/** What is missing, with the commands that mend it. */
function missing() {
  if (!connected) return { title: "The viewer's server does not answer; trying again …", lines: ["pliant view"] };
  if (!link) return null;
  if (link.fault) return { title: link.fault, lines: [] };
  if (performance.now() - frameHeard > 2500) {
    const lines = link.others.length > 0
      ? link.others.map((prefix) => `pliant view --prefix ${prefix}`)
      : ["pliant run --source 'simulated:cushion?frames=100000' --pace realtime"];
    const advice = link.others.length > 0 ? "Another tracker publishes here:" : "Start a tracker, for example:";
    // One on another machine is heard only where its messages may leave that machine.
    const remote = `A tracker on another machine publishes with: --lcm-url '${link.url.replace(/ttl=0/, "ttl=1")}'`;
    return { title: `Nothing is published on ${link.prefix}_* at ${link.url}.`, advice, lines, remote };
  }
  if (!scene) return { title: "This browser has no WebGL: numbers only.", lines: [] };
  if (!model && panel.last?.state === "tracking")
    return { title: "The model was not announced yet; it comes within some seconds.", lines: [] };
  return null;
}

function refresh() {
  const fault = missing();
  const notice = byId("notice");
  notice.hidden = !fault;
  if (fault) {
    const title = document.createElement("b");
    title.textContent = fault.title;
    notice.replaceChildren(title, fault.advice ?? "", ...fault.lines.map((line) => {
      const code = document.createElement("code");
      code.textContent = line;
      return code;
    }), fault.remote ?? "");
    if (connected && link && !link.fault && performance.now() - frameHeard > 2500 && !paused) panel.silence();
  }
  byId("scene").classList.toggle("old", Boolean(fault) && !paused);
  if (paused) return;
  const noDepth = performance.now() - depthHeard > 2500 && !fault;
  if (noDepth) scene?.forgetDepth();
  panel.showFrame(model, noDepth && scene?.showDepth ? "No depth picture is published: [lcm] publish_depth = true" : "");
  panel.tick(performance.now(), link);
}

function setPaused(state) {
  paused = state;
  byId("pause").setAttribute("aria-pressed", String(paused));
  byId("pause").textContent = paused ? "Go on" : "Pause";
  if (!paused) {
    for (const kind of ["model", "status", "frame", "depth"]) if (waiting[kind]) show(waiting[kind]);
    waiting = {};
    refresh();
  }
}

function toggle(id, property) {
  if (!scene) return;
  scene[property] = !scene[property];
  byId(id).setAttribute("aria-pressed", String(scene[property]));
  scene.applyToggles();
}

function toggleKeys() {
  const keys = byId("keys");
  keys.hidden = !keys.hidden;
  byId("help").setAttribute("aria-expanded", String(!keys.hidden));
}

const actions = {
  pause: () => setPaused(!paused),
  reset: () => scene?.reset(),
  depth: () => toggle("depth", "showDepth"),
  axes: () => toggle("axes", "showAxes"),
  hidden: () => toggle("hidden", "showHidden"),
  help: toggleKeys,
};
for (const [id, action] of Object.entries(actions)) {
  const button = byId(id);
  button.addEventListener("click", (event) => {
    action();
    // A button clicked by pointer keeps no focus: the space bar stays for pausing.
    if (event.detail > 0) button.blur();
  });
}

const keys = {
  " ": actions.pause, r: actions.reset, d: actions.depth, a: actions.axes, h: actions.hidden, "?": actions.help,
  ArrowLeft: () => scene?.orbit(-0.1, 0), ArrowRight: () => scene?.orbit(0.1, 0),
  ArrowUp: () => scene?.orbit(0, -0.1), ArrowDown: () => scene?.orbit(0, 0.1),
  "+": () => scene?.zoom(0.9), "=": () => scene?.zoom(0.9), "-": () => scene?.zoom(1 / 0.9),
};
window.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  // A button that has the focus answers to the space bar itself.
  if (event.key === " " && event.target instanceof HTMLButtonElement) return;
  const action = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!action) return;
  event.preventDefault();
  action();
});

setInterval(refresh, 1000);
(function draw() {
  scene?.render();
  requestAnimationFrame(draw);
})();
