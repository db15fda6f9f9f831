// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0

// Foxglove's WebSocket protocol, as far as this page needs it.

// Connects, and connects again when the other side is gone. `listener` has
//   opened(session)     session: another text for every run
//   closed()
//   message(topic, bytes)
class Connection {
  constructor(topics, listener) {
    this.topics = topics;
    this.listener = listener;
    this.calls = new Map();  // those that are not answered yet, by number
    this.nextCall = 1;
    this.pause = 250;  // ms until the next try
    this.connect();
  }

  connect() {
    const url = location.href.replace(/^http/, "ws").replace(/#.*$/, "");
    const socket = this.socket = new WebSocket(url, ["foxglove.sdk.v1", "foxglove.websocket.v1"]);
    socket.binaryType = "arraybuffer";
    this.channels = new Map();  // id -> topic
    this.services = new Map();  // name -> id
    socket.addEventListener("message", (event) => {
      if (typeof event.data === "string")
        this.takeText(JSON.parse(event.data));
      else
        this.takeBinary(new Uint8Array(event.data));
    });
    socket.addEventListener("close", () => {
      this.listener.closed();
      for (const {reject} of this.calls.values()) reject(new Error("the connection is closed"));
      this.calls.clear();
      setTimeout(() => this.connect(), this.pause);
      this.pause = Math.min(2000, 2 * this.pause);
    });
  }

  takeText(message) {
    if (message.op === "serverInfo") {
      this.pause = 250;
      this.listener.opened(message.sessionId);
    } else if (message.op === "advertise") {
      const wanted = message.channels.filter((channel) => this.topics.includes(channel.topic));
      for (const {id, topic} of wanted) this.channels.set(id, topic);
      const subscriptions = wanted.map(({id}) => ({id, channelId: id}));
      this.socket.send(JSON.stringify({op: "subscribe", subscriptions}));
    } else if (message.op === "advertiseServices") {
      for (const {id, name} of message.services) this.services.set(name, id);
    } else if (message.op === "serviceCallFailure") {
      this.settle(message.callId, "reject", new Error(message.message));
    }
  }

  takeBinary(bytes) {
    const view = new DataView(bytes.buffer);
    if (bytes[0] === 1) {
      this.listener.message(this.channels.get(view.getUint32(1, true)), bytes.subarray(13));
    } else if (bytes[0] === 3) {
      const text = bytes.subarray(13 + view.getUint32(9, true));
      this.settle(view.getUint32(5, true), "resolve", JSON.parse(new TextDecoder().decode(text)));
    }
  }

  settle(id, how, value) {
    const call = this.calls.get(id);
    this.calls.delete(id);
    if (call) call[how](value);
  }

  // The answer of a service, as a promise.
  call(name, request) {
    const service = this.services.get(name);
    if (service === undefined || this.socket.readyState !== WebSocket.OPEN) {
      return Promise.reject(new Error("not offered: " + name));
    }
    const text = new TextEncoder().encode("json" + JSON.stringify(request));
    const bytes = new Uint8Array(13 + text.length);
    const view = new DataView(bytes.buffer);
    const id = this.nextCall++;
    view.setUint8(0, 2);
    view.setUint32(1, service, true);
    view.setUint32(5, id, true);
    view.setUint32(9, 4, true);
    bytes.set(text, 13);
    this.socket.send(bytes);
    return new Promise((resolve, reject) => this.calls.set(id, {resolve, reject}));
  }
}
