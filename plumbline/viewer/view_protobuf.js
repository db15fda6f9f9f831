// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0

// Messages in the wire format of protobuf, by tables: number of the field -> [name, type], type one
// of "text", "bytes", "number" (integers, bool), "double", "float[]", "uint32[]", "int32[]", a
// table, or [table] for repeated messages. Fields that are missing in the message are so in the
// result, but for lists, which are empty.

const VECTOR = {
  1: ["x", "double"],
  2: ["y", "double"],
  3: ["z", "double"],
  4: ["w", "double"]
};
const POSE = {
  1: ["position", VECTOR],
  2: ["orientation", VECTOR]
};
const STAMP = {
  1: ["seconds", "number"],
  2: ["nanos", "number"]
};
const COMPRESSED_IMAGE = {
  1: ["timestamp", STAMP],
  2: ["data", "bytes"],
  3: ["format", "text"]
};
const FRAME = {
  1: ["number", "number"],
  2: ["status", "text"],
  3: ["reason", "text"],
  4: ["map", "number"],
  5: ["pose", POSE],
  6: ["keyframe", "number"],
  7: ["inlierPoints", "number"],
  8: ["inlierLines", "number"],
  9: ["stages", [{1: ["name", "text"], 2: ["milliseconds", "double"]}]],
  10: ["shed", "text"],
  11: ["pointPx", "float[]"],
  12: ["pointIds", "int32[]"],
  13: ["linePx", "float[]"],
  14: ["lineIds", "int32[]"],
  15: ["image", "bytes"]
};
const UPDATE = {
  1: ["timestamp", STAMP],
  2: [
    "run", {
      1: ["name", "text"],
      2: ["frames", "number"],
      3: ["framesExpected", "number"],
      4: ["dropped", "number"],
      5: ["lost", "number"],
      6: ["framesPerSecond", "double"],
      7: ["paused", "number"],
      8: ["canPause", "number"],
      9: ["finished", "number"],
      10: [
        "camera", {
          1: ["width", "number"],
          2: ["height", "number"],
          3: ["fx", "double"],
          4: ["fy", "double"],
          5: ["cx", "double"],
          6: ["cy", "double"],
          7: ["baseline", "double"]
        }
      ],
      11: ["savedMap", "number"]
    }
  ],
  3: ["frame", FRAME],
  4: [
    "map", {
      1: ["map", "number"],
      2: ["from", "number"],
      3: ["to", "number"],
      4: ["pointIds", "uint32[]"],
      5: ["pointPositions", "float[]"],
      6: ["gonePoints", "uint32[]"],
      7: ["lineIds", "uint32[]"],
      8: ["lineEnds", "float[]"],
      9: ["goneLines", "uint32[]"],
      10: ["keyframeIds", "uint32[]"],
      11: ["keyframeFrames", "uint32[]"],
      12: ["keyframePoses", "float[]"],
      13: ["goneKeyframes", "uint32[]"],
      14: ["edges", "uint32[]"],
      15: ["lineEstablished", "uint32[]"]
    }
  ],
  5: [
    "events", [{
      1: ["kind", "text"],
      2: ["frame", "number"],
      3: ["keyframe", "number"],
      4: ["older", "number"],
      5: ["points", "number"],
      6: ["lines", "number"],
      7: ["moved", "double"]
    }]
  ]
};

const LISTS = {
  "float[]": Float32Array,
  "uint32[]": Uint32Array,
  "int32[]": Int32Array
};

function emptyMessage(table) {
  const message = {};
  for (const [name, type] of Object.values(table)) {
    if (Array.isArray(type)) message[name] = [];
    if (LISTS[type]) message[name] = new LISTS[type](0);
  }
  return message;
}

// `bytes` is a Uint8Array. Throws a RangeError where it ends early.
function readMessage(bytes, table) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const message = emptyMessage(table);
  let at = 0;
  const varint = () => {
    let value = 0, factor = 1;
    for (;;) {
      const byte = view.getUint8(at++);
      value += (byte & 127) * factor;
      if (byte < 128) return value;
      factor *= 128;
    }
  };
  while (at < bytes.length) {
    const tag = varint();
    const [name, type] = table[Math.floor(tag / 8)] || [];
    const wire = tag & 7;
    if (wire === 0) {
      const value = varint();
      if (name) message[name] = value;
    } else if (wire === 1) {
      if (name) message[name] = view.getFloat64(at, true);
      at += 8;
    } else if (wire === 5) {
      at += 4;
    } else {
      const length = varint();
      if (at + length > bytes.length) throw new RangeError("a message ends early");
      if (name) takeBytes(message, name, type, bytes.subarray(at, at + length));
      at += length;
    }
  }
  return message;
}

function takeBytes(message, name, type, bytes) {
  if (type === "text") {
    message[name] = new TextDecoder().decode(bytes);
  } else if (type === "bytes") {
    message[name] = bytes;
  } else if (LISTS[type]) {
    // Copied, since lists of numbers must begin at a multiple of four bytes.
    message[name] = new LISTS[type](bytes.slice().buffer);
  } else if (Array.isArray(type)) {
    message[name].push(readMessage(bytes, type[0]));
  } else {
    message[name] = readMessage(bytes, type);
  }
}
