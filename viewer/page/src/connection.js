// The socket to nextview_viewer: see outbox.h for what travels. Comes back by itself.

const kFirstWait_ms = 250;
const kLongestWait_ms = 4000;

/// listener: opened(), closed(), text(message), binary(kind, run, view, count, body: DataView)
export class Connection {
  constructor(listener) {
    this.listener = listener;
    this.wait_ms = kFirstWait_ms;
    this.open();
  }

  open() {
    const socket = new WebSocket(`ws://${location.host}/socket`);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    let got = 0;
    socket.onopen = () => {
      this.wait_ms = kFirstWait_ms;
      this.listener.opened();
    };
    socket.onmessage = ({ data }) => {
      if (typeof data === 'string') {
        this.listener.text(JSON.parse(data));
      } else {
        const head = new DataView(data);
        this.listener.binary(head.getUint8(0), head.getUint8(1), head.getUint32(4, true), head.getUint32(8, true),
          new DataView(data, 12));
      }
      got += 1;
      this.say({ got });
    };
    socket.onclose = () => {
      this.listener.closed();
      setTimeout(() => this.open(), this.wait_ms);
      this.wait_ms = Math.min(2 * this.wait_ms, kLongestWait_ms);
    };
  }

  say(words) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(words));
  }
}
