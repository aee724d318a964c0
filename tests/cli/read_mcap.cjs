// node read_mcap.cjs X.mcap X.csv: reads a file of `ayumi export --format mcap` by the libraries of
// Foxglove, in order and by its index, with all checksums; compares its schemas with those of
// Foxglove, every message with its schema, and its numbers with the .csv of the same log.
const assert = require("assert");
const fs = require("fs");
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const { decompress } = require("fzstd");
const { crc32 } = require("@foxglove/crc");
const { pathToFileURL } = require("url");

const bytes = new Uint8Array(fs.readFileSync(process.argv[2]));
const decompressHandlers = { zstd: (data, size) => decompress(data, new Uint8Array(Number(size))) };

// Every field that is described is a field of the official schema, of the same type, and every
// field that the official schema requires is described.
function compareSchemas(mine, official, place) {
  if (official.oneOf) {
    // An enumeration of integers.
    assert.strictEqual(mine.type, "integer", place);
    return;
  }
  assert.strictEqual(mine.type, official.type, place);
  if (mine.type === "array") {
    const empty = Object.keys(mine.items.properties ?? { some: 0 }).length === 0;
    if (!empty) compareSchemas(mine.items, official.items, place + "[]");
  }
  if (mine.type !== "object") return;
  for (const [key, value] of Object.entries(mine.properties)) {
    assert.ok(official.properties[key], `${place}.${key} is no field of Foxglove's schema`);
    compareSchemas(value, official.properties[key], `${place}.${key}`);
  }
  for (const key of official.required ?? [])
    assert.ok(mine.properties[key], `${place}.${key} is required by Foxglove's schema`);
}

function validate(value, schema, place) {
  if (schema.oneOf) {
    assert.ok(schema.oneOf.some((one) => one.const === value), `${place}: ${value}`);
    return;
  }
  if (schema.type === "array") {
    assert.ok(Array.isArray(value), place);
    value.forEach((item, i) => validate(item, schema.items, `${place}[${i}]`));
  } else if (schema.type === "object") {
    assert.ok(typeof value === "object" && value !== null && !Array.isArray(value), place);
    for (const key of Object.keys(value)) {
      assert.ok(schema.properties[key], `${place}.${key} is not in the schema`);
      validate(value[key], schema.properties[key], `${place}.${key}`);
    }
    for (const key of schema.required ?? []) assert.ok(key in value, `${place}.${key} is missing`);
  } else if (schema.type === "integer") {
    assert.ok(Number.isInteger(value), `${place}: ${value}`);
    if ("minimum" in schema) assert.ok(value >= schema.minimum, place);
    if ("maximum" in schema) assert.ok(value <= schema.maximum, place);
  } else {
    assert.strictEqual(typeof value, schema.type, place);
  }
}

function numbersOf(node, path, found) {
  for (const [key, value] of Object.entries(node)) {
    const here = path ? `${path}.${key}` : key;
    if (typeof value === "number") found.set(here, value);
    else numbersOf(value, here, found);
  }
  return found;
}

// "/left" {force: {z}} is the column "left.force.z"; the topic of most is "/state".
const groups = ["measured", "cmd", "ref", "left", "right", "push", "contact", "work", "disturbance"];
function columnsOf(topic, message) {
  const group = topic.slice(1);
  return numbersOf(message, groups.includes(group) ? group : "", new Map());
}

async function main() {
  const file = require.resolve("@foxglove/schemas/jsonschema.js");
  const schemasOfFoxglove = await import(pathToFileURL(file).href);
  const official = schemasOfFoxglove.default ?? schemasOfFoxglove;
  const lines = fs.readFileSync(process.argv[3], "utf8").trim().split("\n");
  const names = lines[0].split(",").map((name) => name.split("[")[0]);
  const rows = lines.slice(1).map((line) => line.split(",").map(Number));

  const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true, includeChunks: true });
  stream.append(bytes);
  const schemas = new Map(), channels = new Map(), streamed = [], kinds = {};
  for (let record; (record = stream.nextRecord()); ) {
    kinds[record.type] = (kinds[record.type] ?? 0) + 1;
    if (record.type === "Schema") schemas.set(record.id, record);
    if (record.type === "Channel") channels.set(record.id, record);
    if (record.type === "Message") streamed.push(record);
  }
  assert.ok(stream.done(), "the file ends early");
  for (const kind of ["Header", "Chunk", "MessageIndex", "DataEnd", "Statistics", "ChunkIndex",
                      "Metadata", "MetadataIndex", "SummaryOffset", "Footer"])
    assert.ok(kinds[kind] > 0, kind);

  // The checksums that the reader leaves alone: of the data section and of the summary.
  const kRecordHead = 9, kFooter = kRecordHead + 20, kMagic = 8;
  const footer = bytes.length - kMagic - kFooter;
  const view = new DataView(bytes.buffer, bytes.byteOffset);
  const summary = Number(view.getBigUint64(footer + kRecordHead, true));
  const dataEnd = summary - kRecordHead - 4;
  assert.strictEqual(view.getUint32(summary - 4, true), crc32(bytes.subarray(0, dataEnd)), "data");
  const sum = crc32(bytes.subarray(summary, footer + kFooter - 4));
  assert.strictEqual(view.getUint32(footer + kFooter - 4, true), sum, "summary");

  const read = { size: async () => BigInt(bytes.length),
                 read: async (offset, length) => bytes.slice(Number(offset), Number(offset + length)) };
  const reader = await McapIndexedReader.Initialize({ readable: read, decompressHandlers });
  assert.strictEqual(reader.statistics.messageCount, BigInt(streamed.length));
  assert.strictEqual(reader.statistics.channelCount, channels.size);
  assert.strictEqual(reader.chunkIndexes.length, kinds.Chunk);
  let indexed = 0;
  for await (const message of reader.readMessages()) {
    assert.ok(reader.channelsById.has(message.channelId));
    indexed += 1;
  }
  assert.strictEqual(indexed, streamed.length, "messages by the index");
  for await (const metadata of reader.readMetadata())
    assert.ok(metadata.metadata.get("robot").length > 0, "metadata");

  const decoder = new TextDecoder(), topics = {}, seen = new Set();
  let last = -1n, compared = 0;
  for (const message of streamed) {
    const channel = channels.get(message.channelId), schema = schemas.get(channel.schemaId);
    assert.strictEqual(channel.messageEncoding, "json");
    assert.strictEqual(schema.encoding, "jsonschema");
    assert.ok(message.logTime >= last, "the order of time");
    last = message.logTime;
    const own = JSON.parse(decoder.decode(schema.data));
    const value = JSON.parse(decoder.decode(message.data));
    topics[channel.topic] = (topics[channel.topic] ?? 0) + 1;
    validate(value, own, channel.topic);
    if (schema.name.startsWith("foxglove.")) {
      const theirs = official[schema.name.slice(9)];
      assert.ok(theirs, schema.name);
      if (!seen.has(channel.topic)) compareSchemas(own, theirs, schema.name);
      if (channel.topic !== "/joint_states" || message.sequence === 0)
        validate(value, theirs, channel.topic);
    } else {
      const row = Math.round(Number(message.logTime) * 1e-6), columns = columnsOf(channel.topic, value);
      for (const [name, number] of columns) {
        const column = names.indexOf(name);
        assert.ok(column >= 0, `${channel.topic} ${name} is no column`);
        assert.strictEqual(number, rows[row][column], `${name} in row ${row}`);
        compared += 1;
      }
    }
    seen.add(channel.topic);
  }
  const numbers = rows.reduce((sum, row) => sum + row.filter(Number.isFinite).length, 0);
  assert.strictEqual(compared, numbers, "every number of the .csv is in the messages");
  for (const topic of ["/joint_states", "/state"]) assert.strictEqual(topics[topic], rows.length);

  // The frames of a foot, multiplied up to the world, agree with the joint states: the base is that
  // of the log.
  const first = streamed.find((m) => channels.get(m.channelId).topic === "/tf");
  const { transforms } = JSON.parse(decoder.decode(first.data));
  const base = transforms.find((t) => t.parent_frame_id === "world");
  assert.strictEqual(base.translation.x, rows[0][names.indexOf("base.x")]);
  const children = new Set(transforms.map((t) => t.child_frame_id));
  assert.strictEqual(children.size, transforms.length, "a frame with two parents");
  for (const t of transforms)
    assert.ok(t.parent_frame_id === "world" || children.has(t.parent_frame_id), t.parent_frame_id);
  console.log(`${streamed.length} messages, ${compared} numbers, ${kinds.Chunk} chunks agree`);
}

main().catch((error) => {
  console.log(error.stack);
  process.exit(1);
});
