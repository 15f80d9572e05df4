// The stream from the server. The page asks for each batch, so a slow browser is sent less, never later.

const KINDS = ["", "link", "status", "model", "frame", "depth"];

/** A packet: kind and length of its header (32 bits each, little-endian), the header as JSON, arrays after it. */
export function parsePacket(buffer) {
  const view = new DataView(buffer);
  const kind = KINDS[view.getUint32(0, true)];
  const length = view.getUint32(4, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, length)));
  let at = 8 + length;
  const take = (Type, count) => {
    const array = new Type(buffer, at, count);
    at += Math.ceil(array.byteLength / 4) * 4;
    return array;
  };
  if (kind === "model") {
    header.positions = take(Float32Array, 3 * header.points);
    header.normals = take(Int8Array, 3 * header.points);
  } else if (kind === "frame") {
    header.labels = take(Int8Array, header.points);
    header.moved = take(Float32Array, 4 * header.deformed);
    header.indices = take(Uint16Array, header.deformed);
  } else if (kind === "depth") {
    header.readings = take(Uint16Array, header.columns * header.rows);
  }
  return { kind, ...header };
}

export class Connection {
  /** `onPacket(packet)`; `onState(connected)`; `wants()` tells what to ask for. */
  constructor(onPacket, onState, wants) {
    Object.assign(this, { onPacket, onState, wants, delay: 300, bytes: 0 });
    this.connect();
    // A server that is gone without a word is left too.
    setInterval(() => { if (this.socket && performance.now() - this.heard > 6000) this.socket.close(); }, 1000);
  }

  connect() {
    const scheme = location.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(`${scheme}//${location.host}/stream${location.search}`);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    this.heard = performance.now();
    socket.onopen = () => { this.delay = 300; this.onState(true); this.ask(); };
    socket.onmessage = (event) => {
      this.heard = performance.now();
      if (typeof event.data === "string") { // the batch is whole
        // After the picture was drawn; a page in the background is drawn rarely and asks rarely.
        if (document.hidden) setTimeout(() => this.ask(), 1000);
        else requestAnimationFrame(() => this.ask());
        return;
      }
      this.bytes += event.data.byteLength;
      this.onPacket(parsePacket(event.data));
    };
    socket.onclose = () => {
      if (this.socket !== socket) return;
      this.socket = null;
      this.onState(false);
      setTimeout(() => this.connect(), this.delay);
      this.delay = Math.min(this.delay * 1.6, 3000);
    };
  }

  ask() {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(this.wants());
  }
}
