"""Reads MCAP files by the public specification (mcap.dev/spec), written apart from the program's writer: every record
by its own lengths, every checksum, and the same messages by way of the summary and the indices."""

import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"


class McapError(ValueError):
    pass


class Fields:
    def __init__(self, data):
        self.data, self.at = data, 0

    def number(self, code):
        size = struct.calcsize("<" + code)
        value = struct.unpack_from("<" + code, self.data, self.at)[0]
        self.at += size
        return value

    def take(self, count):
        if count > len(self.data) - self.at:
            raise McapError("a length beyond its record")
        self.at += count
        return self.data[self.at - count:self.at]

    def text(self):
        return self.take(self.number("I")).decode()

    def rest(self):
        return self.take(len(self.data) - self.at)


def records(data, at, end):
    """(opcode, content, offset) one after the other."""
    while at < end:
        opcode, length = struct.unpack_from("<BQ", data, at)
        if at + 9 + length > end:
            raise McapError("a record beyond the file")
        yield opcode, data[at + 9:at + 9 + length], at
        at += 9 + length


def read_message(content):
    fields = Fields(content)
    channel, _, log_time, publish_time = (fields.number(code) for code in "HIQQ")
    return channel, log_time, publish_time, bytes(fields.rest())


class Mcap:
    def __init__(self, path):
        with open(path, "rb") as file:
            self.data = file.read()
        if self.data[:8] != MAGIC or self.data[-8:] != MAGIC:
            raise McapError("no magic bytes at both ends")
        self.schemas, self.channels, self.messages, self.chunks = {}, {}, [], []
        seen = []
        for opcode, content, at in records(self.data, 8, len(self.data) - 8):
            seen.append(opcode)
            self.take(opcode, content, at)
        if seen[0] != 0x01 or seen[-1] != 0x02 or seen.count(0x0F) != 1:
            raise McapError("header, end of data or footer is not where it belongs")
        self.check_summary()

    def take(self, opcode, content, at):
        fields = Fields(content)
        if opcode == 0x03:
            number = fields.number("H")
            self.schemas[number] = (fields.text(), fields.text(), fields.text())
        elif opcode == 0x04:
            number, schema = fields.number("H"), fields.number("H")
            self.channels[number] = (fields.text(), fields.text(), schema)
        elif opcode == 0x05:
            self.messages.append(read_message(content))
        elif opcode == 0x06:
            first, last, size, crc = (fields.number(code) for code in "QQQI")
            if fields.text() != "":
                raise McapError("compression")
            inner = fields.take(fields.number("Q"))
            if len(inner) != size or zlib.crc32(inner) != crc:
                raise McapError("a chunk's size or checksum is wrong")
            before = len(self.messages)
            for inner_opcode, inner_content, _ in records(inner, 0, len(inner)):
                self.take(inner_opcode, inner_content, 0)
            times = [message[1] for message in self.messages[before:]]
            if (min(times), max(times)) != (first, last):
                raise McapError("a chunk's times are wrong")
            self.chunks.append((at, inner))
        elif opcode == 0x0F:
            if fields.number("I") != zlib.crc32(self.data[:at]):
                raise McapError("the data's checksum is wrong")
        elif opcode == 0x02:
            self.summary_at, self.offsets_at, self.summary_crc = (fields.number(code) for code in "QQI")
            self.footer_at = at

    def check_summary(self):
        covered = self.data[self.summary_at:self.footer_at + 9 + 16]
        if zlib.crc32(covered) != self.summary_crc:
            raise McapError("the summary's checksum is wrong")
        indexed, statistics = [], None
        for opcode, content, at in records(self.data, self.summary_at, self.offsets_at):
            fields = Fields(content)
            if opcode == 0x08:
                indexed += self.by_index(fields)
            elif opcode == 0x0B:
                statistics = [fields.number(code) for code in "QHIIIIQQ"]
        if sorted(indexed) != sorted(self.messages):
            raise McapError("the indices do not lead to the messages")
        times = [message[1] for message in self.messages]
        expected = [len(self.messages), len(self.schemas), len(self.channels), 0, 0, len(self.chunks), min(times),
                    max(times)]
        if statistics != expected:
            raise McapError(f"the statistics are {statistics}, not {expected}")
        for _, content, _ in records(self.data, self.offsets_at, self.footer_at):
            fields = Fields(content)
            group, start, length = (fields.number(code) for code in "BQQ")
            if any(opcode != group for opcode, _, _ in records(self.data, start, start + length)):
                raise McapError("a summary offset leads elsewhere")

    def by_index(self, fields):
        _, _, offset, length = (fields.number(code) for code in "QQQQ")
        chunk = next(inner for at, inner in self.chunks if at == offset)
        places = Fields(fields.take(fields.number("I")))
        while places.at < len(places.data):
            channel, at = places.number("H"), places.number("Q")
            index = Fields(next(records(self.data, at, len(self.data)))[1])
            if self.data[at] != 0x07 or index.number("H") != channel or at < offset + length:
                raise McapError("no message index where one should be")
            entries = Fields(index.take(index.number("I")))
            while entries.at < len(entries.data):
                time, where = entries.number("Q"), entries.number("Q")
                opcode, content, _ = next(records(chunk, where, len(chunk)))
                message = read_message(content)
                if opcode != 0x05 or message[0] != channel or message[1] != time:
                    raise McapError("an index entry leads elsewhere")
                yield message

    def on(self, topic):
        """(publish_time, data) of a topic's messages in the file's order."""
        number = next(number for number, channel in self.channels.items() if channel[0] == topic)
        return [(publish, data) for channel, _, publish, data in self.messages if channel == number]

    def schema_of(self, topic):
        return next(self.schemas[channel[2]] for channel in self.channels.values() if channel[0] == topic)
