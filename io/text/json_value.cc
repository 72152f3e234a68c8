#include "elastimate/io/text/json_value.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/input_file.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

using nlohmann::json;

/// Characters of the parser's own messages, which quote the text.
constexpr std::size_t kLongestParserMessage = 160;

/// Below what a double holds, above all that a file counts.
constexpr double kLargestInteger = 1e12 - 1;

/// Without this, the last of several equal keys would silently win.  (A filter
/// of json::parse would do, but takes a time that grows with the square of the
/// length of a list.)
class RepeatedKeyCheck : public nlohmann::json_sax<json> {
 public:
  explicit RepeatedKeyCheck(const std::filesystem::path& path) : path_(path) {}

  const std::string& LastKey() const { return last_key_; }

  bool start_object(std::size_t /*size*/) override {
    keys_.emplace_back();
    return true;
  }
  bool key(string_t& key) override {
    last_key_ = key;
    if (!keys_.back().insert(key).second) {
      ThrowInputError(path_, "the key \"" + Printable(key) +
                                 "\" is given twice in one object; remove one");
    }
    return true;
  }
  bool end_object() override {
    keys_.pop_back();
    return true;
  }
  bool start_array(std::size_t /*size*/) override { return true; }
  bool end_array() override { return true; }
  bool null() override { return true; }
  bool boolean(bool /*value*/) override { return true; }
  bool number_integer(number_integer_t /*value*/) override { return true; }
  bool number_unsigned(number_unsigned_t /*value*/) override { return true; }
  bool number_float(number_float_t /*value*/,
                    const string_t& /*text*/) override {
    return true;
  }
  bool string(string_t& /*text*/) override { return true; }
  bool binary(binary_t& /*bytes*/) override { return true; }
  // Whose sentence json::parse has.
  bool parse_error(std::size_t /*position*/, const std::string& /*token*/,
                   const json::exception& /*error*/) override {
    return false;
  }

 private:
  const std::filesystem::path& path_;
  std::string last_key_;
  std::vector<std::set<std::string>> keys_;
};

std::string Join(const std::vector<std::string>& words) {
  std::string joined;
  for (const std::string& word : words) {
    joined += joined.empty() ? word : ", " + word;
  }
  return joined;
}

}  // namespace

json ParseJsonFile(const std::filesystem::path& path) {
  CheckReadable(path);
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  RepeatedKeyCheck check(path);
  json::sax_parse(text, &check);
  try {
    return json::parse(text);
  } catch (const json::out_of_range& error) {
    // "[json.exception...] number overflow parsing '1e999'"; without a place.
    std::string number = error.what();
    number.erase(0, number.find('\'') + 1);
    number.erase(std::min(number.find('\''), number.size()));
    ThrowInputError(path, "the number " + Printable(number) + " of the key \"" +
                              Printable(check.LastKey()) +
                              "\" is beyond the range of a double; correct it");
  } catch (const json::exception& error) {
    // "[json.exception...] parse error at line 3, column 7: ..."
    std::string message = error.what();
    const std::string place = "parse error at ";
    if (const auto found = message.find(place); found != std::string::npos) {
      message.erase(0, found + place.size());
    }
    ThrowInputError(
        path, Printable(message, kLongestParserMessage) + "; correct the JSON");
  }
}

void JsonValue::Fail(const std::string& sentence) const {
  ThrowInputError(*file_,
                  (place_.empty() ? "the document" : place_) + " " + sentence);
}

void JsonValue::CheckKeys(const std::vector<std::string>& keys) const {
  if (!value_->is_object()) {
    Fail("must be an object with the keys " + Join(keys));
  }
  for (const auto& [key, value] : value_->items()) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      Fail("has the unknown key \"" + Printable(key) +
           "\"; the keys known here are " + Join(keys));
    }
  }
}

JsonValue JsonValue::At(const std::string& key) const {
  const std::string place = place_.empty() ? key : place_ + "." + key;
  if (!value_->is_object() || !value_->contains(key)) {
    ThrowInputError(*file_, place + " is missing; add it");
  }
  return JsonValue(*file_, value_->at(key), place);
}

std::vector<JsonValue> JsonValue::Items() const {
  if (!value_->is_array()) {
    Fail("must be a list");
  }
  std::vector<JsonValue> items;
  for (const json& item : *value_) {
    items.emplace_back(*file_, item,
                       place_ + "[" + std::to_string(items.size()) + "]");
  }
  return items;
}

std::string JsonValue::String() const {
  if (!value_->is_string()) {
    Fail("must be a string");
  }
  return value_->get<std::string>();
}

bool JsonValue::IsInteger() const {
  return value_->is_number_integer() ||
         (value_->is_number_float() &&
          value_->get<double>() == std::floor(value_->get<double>()));
}

long long JsonValue::Integer() const {
  if (!IsInteger()) {
    Fail("must be an integer");
  }
  // Beyond its range nlohmann's get wraps around.
  if (std::abs(value_->get<double>()) > kLargestInteger) {
    Fail("must be an integer of at most 12 digits");
  }
  return value_->get<long long>();
}

double JsonValue::Number() const {
  if (!value_->is_number()) {
    Fail("must be a number");
  }
  return value_->get<double>();
}

bool JsonValue::Boolean() const {
  if (!value_->is_boolean()) {
    Fail("must be true or false");
  }
  return value_->get<bool>();
}

Eigen::VectorXd JsonValue::Vector(Eigen::Index size) const {
  if (ListSize() != size) {
    Fail("must be a list of " + std::to_string(size) + " numbers");
  }
  Eigen::VectorXd vector(size);
  Eigen::Index i = 0;
  for (const JsonValue& item : Items()) {
    vector[i++] = item.Number();
  }
  return vector;
}

Eigen::Index JsonValue::ListSize() const {
  return value_->is_array() ? static_cast<Eigen::Index>(value_->size()) : 0;
}

}  // namespace elastimate
