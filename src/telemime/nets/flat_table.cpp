// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/flat_table.h"

#include "telemime/core/errors.h"

namespace telemime {
namespace {

[[noreturn]] void refuse(const std::string& cause) {
  throw Error(ErrorKind::config, "the network file is damaged: " + cause, "Install the models again.");
}

}  // namespace

FlatTable FlatTable::root(std::span<const std::byte> file, std::string_view identifier) {
  constexpr std::size_t kIdentifierPlace = 4;
  if (file.size() < kIdentifierPlace + identifier.size() ||
      std::memcmp(file.data() + kIdentifierPlace, identifier.data(), identifier.size()) != 0) {
    throw Error(
        ErrorKind::config,
        "this is not a TensorFlow Lite file: it does not contain the identifier " + std::string(identifier),
        "Install the models again.");
  }
  std::uint32_t offset = 0;
  std::memcpy(&offset, file.data(), sizeof offset);
  return FlatTable(file, offset);
}

FlatTable::FlatTable(std::span<const std::byte> file, std::size_t place) : file_(file), place_(place) {
  const std::int64_t fields = static_cast<std::int64_t>(place) - read<std::int32_t>(place);
  if (fields < 0) {
    refuse("a table has no list of fields");
  }
  fields_ = static_cast<std::size_t>(fields);
  fields_size_ = read<std::uint16_t>(fields_);
}

std::span<const std::byte> FlatTable::part(std::size_t at, std::size_t size) const {
  if (at > file_.size() || size > file_.size() - at) {
    refuse("it refers to bytes after its end");
  }
  return file_.subspan(at, size);
}

// The place of a field's value in the file; 0 if the field is absent.
std::size_t FlatTable::field_place(int field) const {
  const std::size_t entry = 4 + 2 * static_cast<std::size_t>(field);
  if (entry + 2 > fields_size_) {
    return 0;
  }
  const std::size_t offset = read<std::uint16_t>(fields_ + entry);
  return offset == 0 ? 0 : place_ + offset;
}

std::size_t FlatTable::follow(std::size_t at) const {
  return at + read<std::uint32_t>(at);
}

std::span<const std::byte> FlatTable::bytes(int field, std::size_t element_size) const {
  const std::size_t at = field_place(field);
  if (at == 0) {
    return {};
  }
  const std::size_t vector = follow(at);
  const std::size_t count = read<std::uint32_t>(vector);
  return part(vector + sizeof(std::uint32_t), count * element_size);
}

std::string FlatTable::text(int field) const {
  const std::span<const std::byte> raw = bytes(field);
  return {reinterpret_cast<const char*>(raw.data()), raw.size()};
}

std::optional<FlatTable> FlatTable::table(int field) const {
  const std::size_t at = field_place(field);
  return at == 0 ? std::nullopt : std::optional(FlatTable(file_, follow(at)));
}

std::vector<FlatTable> FlatTable::tables(int field) const {
  const std::span<const std::byte> raw = bytes(field, sizeof(std::uint32_t));
  std::vector<FlatTable> result;
  for (std::size_t i = 0; i < raw.size(); i += sizeof(std::uint32_t)) {
    result.push_back(FlatTable(file_, follow(static_cast<std::size_t>(raw.data() - file_.data()) + i)));
  }
  return result;
}

}  // namespace telemime
