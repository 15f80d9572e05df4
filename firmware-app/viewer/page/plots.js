// Curves of the last minute.

const SECONDS = 60;
export const COLOURS = ["#56b4e9", "#e69f00", "#2fb36b", "#f0e442", "#cc79a7", "#d55e00", "#7fd6c2", "#b8a1ff", "#ffffff"];

export class Plot {
  constructor(canvas) {
    this.canvas = canvas;
    this.rows = []; // { time, values: { name: number } }
  }

  add(time, values) {
    this.rows.push({ time, values });
    while (this.rows[0].time < time - SECONDS * 1000) this.rows.shift();
  }

  names() {
    return [...new Set(this.rows.flatMap((row) => Object.keys(row.values)))];
  }

  draw(now) {
    const ratio = Math.min(window.devicePixelRatio, 2);
    const { clientWidth, clientHeight } = this.canvas;
    if (!clientWidth) return;
    const width = this.canvas.width = clientWidth * ratio;
    const height = this.canvas.height = clientHeight * ratio;
    const context = this.canvas.getContext("2d");
    const rows = this.rows.filter((row) => row.time > now - SECONDS * 1000);
    const most = Math.max(1e-6, ...rows.flatMap((row) => Object.values(row.values))) * 1.12;
    const x = (time) => width * (1 - (now - time) / (SECONDS * 1000));
    const y = (value) => height * (1 - value / most);
    context.strokeStyle = "#2c3338";
    for (let part = 1; part < 4; ++part) {
      context.beginPath();
      context.moveTo(0, height * part / 4);
      context.lineTo(width, height * part / 4);
      context.stroke();
    }
    context.lineWidth = 1.5 * ratio;
    context.lineJoin = "round";
    this.names().forEach((name, index) => {
      context.strokeStyle = COLOURS[index % COLOURS.length];
      context.beginPath();
      let before = null;
      for (const row of rows) {
        const value = row.values[name];
        if (value === undefined) continue;
        // A gap of silence is a gap in the curve.
        if (before === null || row.time - before > 3500) context.moveTo(x(row.time), y(value));
        else context.lineTo(x(row.time), y(value));
        before = row.time;
      }
      context.stroke();
    });
    context.fillStyle = "#a4adb5";
    context.font = `${11 * ratio}px system-ui, sans-serif`;
    if (rows.length > 0) context.fillText(String(Number(most.toPrecision(2))), 3 * ratio, 12 * ratio);
    context.fillText(`${SECONDS} s ago`, 3 * ratio, height - 4 * ratio);
  }
}
