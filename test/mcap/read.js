// Every message of an MCAP as the official reader gives it: a JSON line each; first line: the summary.
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const { parse } = require("@foxglove/rosmsg");
const { MessageReader } = require("@foxglove/rosmsg-serialization");
const fs = require("fs").promises;

const plain = (key, value) => {
  if (typeof value === "bigint") return Number.isSafeInteger(Number(value)) ? Number(value) : value.toString();
  if (ArrayBuffer.isView(value)) return Array.from(value, (one) => plain("", one));
  if (typeof value === "number" && !Number.isFinite(value)) return String(value);
  return value;
};

async function main(file) {
  const handle = await fs.open(file);
  const size = BigInt((await handle.stat()).size);
  const readable = {
    size: async () => size,
    read: async (offset, length) => {
      const bytes = new Uint8Array(Number(length));
      await handle.read(bytes, 0, bytes.length, Number(offset));
      return bytes;
    },
  };
  const stream = new McapStreamReader({ validateCrcs: true }); // the chunks' and the data section's
  stream.append(new Uint8Array(await fs.readFile(file)));
  let streamed = 0;
  for (let record; (record = stream.nextRecord()); ) streamed += record.type === "Message" ? 1 : 0;
  const reader = await McapIndexedReader.Initialize({ readable });
  const channels = [...reader.channelsById.values()].map((channel) => ({
    topic: channel.topic,
    type: reader.schemasById.get(channel.schemaId).name,
    encodings: [channel.messageEncoding, reader.schemasById.get(channel.schemaId).encoding],
    metadata: Object.fromEntries(channel.metadata),
  }));
  const lines = [JSON.stringify({ profile: reader.header.profile, streamed, complete: stream.done(),
    messages: reader.statistics.messageCount.toString(), channels })];
  const readers = new Map();
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    if (!readers.has(schema.id)) readers.set(schema.id, new MessageReader(parse(new TextDecoder().decode(schema.data))));
    lines.push(JSON.stringify([channel.topic, message.logTime.toString(), readers.get(schema.id).readMessage(message.data)], plain));
  }
  process.stdout.write(lines.join("\n") + "\n");
}
main(process.argv[2]).catch((error) => { console.error(error); process.exit(1); });
