// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/json_field.h"

namespace telemime {

std::optional<nlohmann::json> parse_if_json(std::string_view text, const JsonSource& source) {
  const auto shallow = [&source](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
    if (depth > source.deepest) {
      throw Error(source.kind,
                  source.name + " is nested more than " + std::to_string(source.deepest) + " levels deep",
                  source.remedy);
    }
    return true;
  };
  nlohmann::json value = nlohmann::json::parse(text, shallow, /*allow_exceptions=*/false);
  return value.is_discarded() ? std::nullopt : std::optional(std::move(value));
}

nlohmann::json parse_json(std::string_view text, const JsonSource& source) {
  auto value = parse_if_json(text, source);
  if (!value) {
    throw Error(source.kind, source.name + " is not JSON", source.remedy);
  }
  return *std::move(value);
}

void JsonField::fail(const std::string& what) const {
  throw Error(source_->kind, place_ + " " + what, source_->remedy);
}

JsonField JsonField::operator[](std::string_view key) const {
  if (!value_->is_object()) {
    fail("must be a JSON object");
  }
  JsonField member = *this;
  member.place_.append(": '").append(key).append("'");
  const auto found = value_->find(key);
  if (found == value_->end()) {
    member.fail("is missing");
  }
  member.value_ = &*found;
  return member;
}

JsonField JsonField::operator[](std::size_t index) const {
  if (index >= size()) {
    fail("is too short");
  }
  JsonField item = *this;
  item.value_ = &(*value_)[index];
  item.place_.append(" [").append(std::to_string(index)).append("]");
  return item;
}

bool JsonField::has(std::string_view key) const {
  return value_->contains(key);
}

std::size_t JsonField::size() const {
  if (!value_->is_array()) {
    fail("must be a list");
  }
  return value_->size();
}

double JsonField::finite(const nlohmann::json& value) const {
  if (!value.is_number() || !std::isfinite(value.get<double>())) {
    fail(&value == value_ ? "must be a finite number" : "must have finite numbers");
  }
  return value.get<double>();
}

double JsonField::number() const {
  return finite(*value_);
}

double JsonField::number(double low, double high) const {
  const double number = finite(*value_);
  if (!(number >= low && number <= high)) {
    fail("must be a number in " + nlohmann::json({low, high}).dump());
  }
  return number;
}

double JsonField::positive() const {
  const double number = finite(*value_);
  if (!(number > 0.0)) {
    fail("must be greater than 0");
  }
  return number;
}

std::int64_t JsonField::integer(std::int64_t low, std::int64_t high) const {
  constexpr double kExact = 9007199254740992.0;  // 2^53: all whole numbers up to it are exact
  std::optional<std::int64_t> number;
  if (value_->is_number_float()) {
    const auto real = value_->get<double>();
    number = std::abs(real) <= kExact && real == std::floor(real)
                 ? std::optional(static_cast<std::int64_t>(real))
                 : std::nullopt;
  } else if (value_->is_number_integer() &&
             (!value_->is_number_unsigned() || value_->get<std::uint64_t>() <= std::uint64_t{INT64_MAX})) {
    number = value_->get<std::int64_t>();
  }
  if (!number || *number < low || *number > high) {
    fail("must be a whole number in " + nlohmann::json({low, high}).dump());
  }
  return *number;
}

bool JsonField::boolean() const {
  if (!value_->is_boolean()) {
    fail("must be true or false");
  }
  return value_->get<bool>();
}

void JsonField::equals(std::string_view wanted) const {
  if (*value_ != wanted) {
    fail("must be \"" + std::string(wanted) + "\"");
  }
}

std::string JsonField::text(std::size_t longest) const {
  if (!value_->is_string()) {
    fail("must be a text");
  }
  const auto& text = value_->get_ref<const std::string&>();
  if (text.size() > longest) {
    fail("must be a text of at most " + std::to_string(longest) + " bytes");
  }
  return text;
}

}  // namespace telemime
