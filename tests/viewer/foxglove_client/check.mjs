// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0

// Foxglove's own client and MCAP's own reader on what the viewer sends and records, decoded by the
// published schemas.
//
//   node check.mjs ws://127.0.0.1:8080 RECORDING.mcap
//
// The run may end while this looks. Exit status: 0 all as it should be, 1 with what is not.
import {open} from "node:fs/promises";
import {createRequire} from "node:module";

const require = createRequire(import.meta.url);
const {FoxgloveClient} = require("@foxglove/ws-protocol");
const {McapIndexedReader} = require("@mcap/core");
const {decompress} = require("fzstd");
const protobuf = require("protobufjs");
const descriptor = require("protobufjs/ext/descriptor");
const WebSocket = require("ws");
const {foxgloveEnumSchemas, foxgloveMessageSchemas, generateProto} =
    require("@foxglove/schemas/internal");

const TOPICS = [
  "/camera/annotations", "/camera/calibration", "/camera/image", "/camera/pose",
  "/camera_right/calibration", "/camera_right/image", "/map/lines", "/map/points",
  "/plumbline/updates", "/tf"
];

function check(holds, what) {
  if (!holds) throw new Error(what);
}

// The published definitions.
function publishedTypes() {
  const root = new protobuf.Root();
  const stamps = `syntax = "proto3"; package google.protobuf;
      message Timestamp { int64 seconds = 1; int32 nanos = 2; }
      message Duration { int64 seconds = 1; int32 nanos = 2; }`;
  protobuf.parse(stamps, root);
  for (const schema of Object.values(foxgloveMessageSchemas)) {
    const enums =
        Object.values(foxgloveEnumSchemas).filter((e) => e.parentSchemaName === schema.name);
    protobuf.parse(generateProto(schema, enums), root, {keepCase: true});
  }
  root.resolveAll();
  return root;
}

// Every field that our schema describes is one of the published type, of the same number and type.
function compareTypes(ours, published) {
  for (const type of ours.lookup("foxglove").nestedArray) {
    if (!(type instanceof protobuf.Type)) continue;
    const known = published.lookupType(`foxglove.${type.name}`);
    for (const field of type.fieldsArray) {
      const same = known.fieldsById[field.id];
      check(same, `${type.name} has no field ${field.id} (${field.name})`);
      check(same.name === field.name, `${type.name}.${field.name} is called ${same.name}`);
      check(same.repeated === field.repeated, `${type.name}.${field.name}: repeated`);
      const [a, b] = [field, same].map((f) => f.resolvedType ? f.resolvedType.name : f.type);
      check(a === b, `${type.name}.${field.name} is ${b}, here ${a}`);
    }
  }
}

function ourTypes(schema) {
  const set = descriptor.FileDescriptorSet.decode(schema);
  const root = protobuf.Root.fromDescriptor(set);
  root.resolveAll();
  return root;
}

const checks = {
  "/camera/image": (m) => check(m.format === "jpeg" && m.data[0] === 0xff && m.data[1] === 0xd8, "a JPEG file"),
  "/camera/calibration": (m) => check(m.width > 0 && m.K.length === 9 && m.P.length === 12, "a camera"),
  "/camera_right/image": (m) => check(m.format === "jpeg" && m.data[0] === 0xff, "a JPEG file"),
  "/camera_right/calibration": (m) => check(m.width > 0 && m.P[3] < 0, "the right camera of a pair"),
  "/camera/annotations": (m) => check(m.points.length > 0 && m.points[0].points.length > 0, "marks"),
  "/camera/pose": (m) => check(m.frame_id === "map" && m.pose.orientation, "a pose"),
  "/tf": (m) => check(m.parent_frame_id === "map" && m.child_frame_id === "camera", "a transform"),
  "/map/points": (m) => check(m.data.length % m.point_stride === 0 && m.fields.length === 3, "a cloud"),
  "/map/lines": (m) => check(m.entities.every((e) => e.lines[0].points.length % 2 === 0), "lines"),
  "/plumbline/updates": (m) => check(m.run.frames >= 0 && m.run.camera.width > 0, "an update")
};

// Calls take(topic, type name, schema, bytes) for messages until every topic has been seen.
function watch(url, take) {
  return new Promise((resolve, reject) => {
    const client = new FoxgloveClient({ws: new WebSocket(url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL])});
    const channels = new Map(), seen = new Set();
    client.on("error", (error) => reject(error || new Error("the connection failed")));
    client.on("close", () => reject(new Error(`closed after ${[...seen]}`)));
    client.on("advertise", (list) => {
      for (const channel of list) channels.set(client.subscribe(channel.id), channel);
    });
    client.on("message", ({subscriptionId, data}) => {
      const {topic, schemaName, schema} = channels.get(subscriptionId);
      const bytes = new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
      try {
        take(topic, schemaName, Buffer.from(schema, "base64"), bytes);
      } catch (error) {
        reject(error);
      }
      seen.add(topic);
      if (seen.size === TOPICS.length) resolve(client.close());
    });
  });
}

async function readRecording(path, take) {
  const file = await open(path);
  const readable = {
    size: async () => BigInt((await file.stat()).size),
    read: async (offset, length) => {
      const bytes = new Uint8Array(Number(length));
      await file.read(bytes, 0, bytes.length, Number(offset));
      return bytes;
    }
  };
  const reader = await McapIndexedReader.Initialize(
      {readable, decompressHandlers: {zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size)))}});
  const counts = new Map();
  let before = 0n;
  for await (const message of reader.readMessages()) {
    check(message.logTime >= before, "messages in the order of time");
    before = message.logTime;
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    counts.set(channel.topic, (counts.get(channel.topic) || 0) + 1);
    take(channel.topic, schema.name, schema.data, message.data);
  }
  const total = [...counts.values()].reduce((sum, count) => sum + count, 0);
  check(BigInt(total) === reader.statistics.messageCount, "as many messages as the statistics say");
  check(reader.chunkIndexes.length === reader.statistics.chunkCount, "an index of every chunk");
  return counts;
}

async function main(url, recording) {
  const published = publishedTypes();
  let ours = null;
  const take = (topic, name, schema, bytes) => {
    if (!ours) {
      ours = ourTypes(schema);
      compareTypes(ours, published);
    }
    const type = (name.startsWith("foxglove.") ? published : ours).lookupType(name);
    checks[topic](type.decode(bytes));
  };
  await watch(url, take);
  console.log("live: every channel was seen, by the published schemas");
  const counts = await readRecording(recording, take);
  check(JSON.stringify([...counts.keys()].sort()) === JSON.stringify(TOPICS), "all channels");
  console.log("recording:", Object.fromEntries(counts));
}

main(...process.argv.slice(2)).catch((error) => {
  console.error("check.mjs:", error.message);
  process.exit(1);
});
