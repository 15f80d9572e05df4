"""LCM in plain Python: receives messages and decodes them by their .lcm files. Needs nothing but Python 3.

Debian has no Python package for LCM. Where you have one, lcm-gen's classes do the same:
    lcm-gen --python drivers/lcm/types/*.lcm
"""

import pathlib
import re
import socket
import struct
import types

PRIMITIVES = {"int8_t": "b", "int16_t": "h", "int32_t": "i", "int64_t": "q", "byte": "B", "float": "f",
              "double": "d", "boolean": "b"}
MASK = (1 << 64) - 1
DEFAULT_URL = "udpm://239.255.76.67:7667?ttl=0"


class DecodeError(ValueError):
    """The bytes are no whole message of a known type."""


class Struct:
    """One type of a .lcm file: its fields, constants and fingerprint."""

    def __init__(self, package, name, body):
        self.package, self.name = package, name
        self.fields, self.constants = [], {}
        for statement in filter(None, (part.strip() for part in body.split(";"))):
            kind, rest = statement.split(None, 1)
            if kind == "const":
                for constant in rest.split(None, 1)[1].split(","):
                    key, value = constant.split("=")
                    self.constants[key.strip()] = float(value) if "." in value else int(value, 0)
                continue
            for member in rest.split(","):
                label, *sizes = re.findall(r"\w+", member)
                self.fields.append((kind, label, sizes))

    def own_hash(self):
        value = 0x12345678

        def add(number):
            nonlocal value
            high = value >> 55
            if value >> 63:  # LCM shifts a signed number
                high |= MASK & ~0x1FF
            value = (((value << 8) & MASK) ^ high) + number & MASK

        def add_text(text):
            add(len(text))
            for character in text.encode():
                add(character)

        for kind, label, sizes in self.fields:
            add_text(label)
            if kind in PRIMITIVES or kind == "string":
                add_text(kind)
            add(len(sizes))
            for size in sizes:
                add(0 if size.isdigit() else 1)
                add_text(size)
        return value


class Types:
    """All types of a folder of .lcm files."""

    def __init__(self, folder):
        self.by_name, self.by_fingerprint = {}, {}
        for path in sorted(pathlib.Path(folder).glob("*.lcm")):
            text = re.sub(r"//[^\n]*|/\*.*?\*/", " ", path.read_text(), flags=re.S)
            package = re.search(r"\bpackage\s+(\w+)\s*;", text)
            for name, body in re.findall(r"\bstruct\s+(\w+)\s*\{(.*?)\}", text, flags=re.S):
                one = Struct(package.group(1) if package else "", name, body)
                self.by_name[name] = one
        for one in self.by_name.values():
            self.by_fingerprint[self.fingerprint(one)] = one

    def fingerprint(self, one):
        value = one.own_hash()
        for kind, _, _ in one.fields:
            if kind in self.by_name:
                value += self.fingerprint(self.by_name[kind])
        value &= MASK
        return ((value << 1) + (value >> 63)) & MASK

    def decode(self, data):
        """An object with the message's fields, its constants and `type_name`."""
        if len(data) < 8:
            raise DecodeError("too short")
        one = self.by_fingerprint.get(int.from_bytes(data[:8], "big"))
        if one is None:
            raise DecodeError("unknown type")
        reader = _Reader(data, 8)
        message = self._decode_struct(one, reader)
        if reader.at != len(data):
            raise DecodeError("bytes left over")
        return message

    def _decode_struct(self, one, reader):
        message = types.SimpleNamespace(type_name=one.name, **one.constants)
        for kind, label, sizes in one.fields:
            shape = [int(size) if size.isdigit() else getattr(message, size) for size in sizes]
            setattr(message, label, self._decode_array(kind, shape, reader))
        return message

    def _decode_array(self, kind, shape, reader):
        if shape and kind in PRIMITIVES:
            count = 1
            for size in shape:
                if size < 0:
                    raise DecodeError("negative count")
                count *= size
            values = reader.unpack(count, PRIMITIVES[kind])
            if kind == "byte":
                values = bytes(values)
            for size in reversed(shape[1:]):
                values = [values[i:i + size] for i in range(0, len(values), size)]
            return values
        if shape:
            if shape[0] < 0:
                raise DecodeError("negative count")
            return [self._decode_array(kind, shape[1:], reader) for _ in range(shape[0])]
        if kind == "string":
            length = reader.unpack(1, "i")[0]
            text = reader.take(length)
            return text[:-1].decode("utf-8", "replace")
        if kind in PRIMITIVES:
            return reader.unpack(1, PRIMITIVES[kind])[0]
        return self._decode_struct(self.by_name[kind], reader)


class _Reader:
    def __init__(self, data, at):
        self.data, self.at = data, at

    def take(self, count):
        if count < 0 or count > len(self.data) - self.at:
            raise DecodeError("cut short")
        self.at += count
        return self.data[self.at - count:self.at]

    def unpack(self, count, code):
        return struct.unpack(f">{count}{code}", self.take(count * struct.calcsize(">" + code)))


class Receiver:
    """Iterates over (channel, bytes) of what arrives at an udpm:// URL."""

    def __init__(self, url=DEFAULT_URL, timeout=None):
        match = re.match(r"udpm://([\d.]*)(?::(\d+))?(?:\?|$)", url)
        if not match:
            raise ValueError(f"'{url}' is no udpm:// URL")
        group, port = match.group(1) or "239.255.76.67", int(match.group(2) or 7667)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2 << 20)
        self.socket.bind((group, port))
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                               socket.inet_aton(group) + socket.inet_aton("0.0.0.0"))
        self.socket.settimeout(timeout)
        self.fragments = {}

    def close(self):
        self.socket.close()

    def __iter__(self):
        return self

    def __next__(self):
        while True:
            packet, sender = self.socket.recvfrom(65536)
            message = self._short(packet) if packet[:4] == b"LC02" else self._fragment(packet, sender)
            if message:
                return message

    @staticmethod
    def _short(packet):
        channel, zero, data = packet[8:].partition(b"\0")
        return (channel.decode("ascii", "replace"), data) if zero else None

    def _fragment(self, packet, sender):
        """Messages above one datagram come in fragments; the first one carries the channel."""
        if packet[:4] != b"LC03" or len(packet) < 20:
            return None
        number, size, offset, index, count = struct.unpack(">IIIHH", packet[4:20])
        data = packet[20:]
        if index == 0:
            channel, zero, data = data.partition(b"\0")
            if not zero or size > 1 << 28:
                return None
            self.fragments[sender] = [number, channel.decode("ascii", "replace"), bytearray(size), count]
        waiting = self.fragments.get(sender)
        if not waiting or waiting[0] != number or offset + len(data) > len(waiting[2]):
            return None
        waiting[2][offset:offset + len(data)] = data
        waiting[3] -= 1
        if waiting[3] > 0:
            return None
        del self.fragments[sender]
        return waiting[1], bytes(waiting[2])


def read_log(path):
    """Iterates over (utime, channel, bytes) of a log of lcm-logger."""
    with open(path, "rb") as log:
        while len(header := log.read(28)) == 28:
            sync, _, utime, channel_size, data_size = struct.unpack(">IqqII", header)
            if sync != 0xEDA1DA01:
                raise ValueError(f"'{path}' is no LCM log")
            channel = log.read(channel_size).decode("ascii", "replace")
            data = log.read(data_size)
            if len(data) == data_size:
                yield utime, channel, data
