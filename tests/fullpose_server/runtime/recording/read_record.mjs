// Reads an MCAP file with the library that Foxglove and Lichtblick read it with, and prints what it found as JSON.
// Run with web/ as the working directory: its node_modules has the library. Arguments: the file, "whole" or "cut".
import { readFile } from "node:fs/promises";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { loadDecompressHandlers } from "@mcap/support";

const [path, how] = process.argv.slice(-2);
const data = new Uint8Array(await readFile(path));
const decompressHandlers = await loadDecompressHandlers();
const text = new TextDecoder();
const channels = {};
const found = [];

async function* indexed() {
  const readable = {
    size: async () => BigInt(data.byteLength),
    read: async (offset, size) => data.slice(Number(offset), Number(offset + size)),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  for (const channel of reader.channelsById.values()) {
    yield { type: "Schema", ...reader.schemasById.get(channel.schemaId) };
    yield channel;
  }
  for await (const message of reader.readMessages()) yield message;
}

async function* streamed() {
  const reader = new McapStreamReader({ decompressHandlers });
  reader.append(data);
  for (let record; (record = reader.nextRecord()); ) yield record;
}

const schemas = new Map();
for await (const record of how === "whole" ? indexed() : streamed()) {
  if (record.type === "Schema") schemas.set(record.id, record);
  if (record.type === "Channel") {
    const schema = schemas.get(record.schemaId);
    channels[record.topic] = {
      id: record.id,
      encoding: record.messageEncoding,
      schemaName: schema.name,
      schemaEncoding: schema.encoding,
      schema: JSON.parse(text.decode(schema.data)),
    };
  }
  if (record.type === "Message") {
    const content = JSON.parse(text.decode(record.data));
    found.push({ channel: record.channelId, sequence: record.sequence, logTime: String(record.logTime), content });
  }
}
console.log(JSON.stringify({ channels, messages: found }));
