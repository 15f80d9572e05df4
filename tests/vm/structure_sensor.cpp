#include "tests/vm/structure_sensor.hpp"

namespace pliant::test {

namespace {

constexpr unsigned kInterface = 4, kEndpoint = 5, kVendorSpecific = 0xff, kBulk = 2, kPacket = 512;
// Depth, picture, and what else there is.
constexpr unsigned kEndpoints[] = {0x81, 0x82, 0x83};

}  // namespace

Bytes StructureSensor::device_descriptor() const {
  return {18, 1, 0, 2, 0, 0, 0, 64, 0x27, 0x1d, 0x00, 0x06, 0, 1, 1, 2, 0, 1};
}

Bytes StructureSensor::configuration_descriptor() const {
  Bytes body;
  for (const unsigned value : {9U, kInterface, 0U, 0U, 3U, kVendorSpecific, 0U, 0U, 0U}) put8(body, value);
  for (const unsigned endpoint : kEndpoints) {
    for (const unsigned value : {7U, kEndpoint, endpoint, kBulk}) put8(body, value);
    put16(body, kPacket);
    put8(body, 0);
  }
  Bytes all = {9, 2};
  put16(all, static_cast<unsigned>(9 + body.size()));
  for (const unsigned value : {1U, 1U, 0U, 0x80U, 250U}) put8(all, value);
  all.insert(all.end(), body.begin(), body.end());
  return all;
}

std::string StructureSensor::text(int index) const {
  return index == 1 ? "PrimeSense" : "PrimeSense Device";
}

}  // namespace pliant::test
