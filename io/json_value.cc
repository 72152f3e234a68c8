#include "elastimate/io/json_value.h"

#include <algorithm>
#include <fstream>
#include <set>

#include "elastimate/io/input_error.h"
#include "elastimate/io/mesh_file.h"
#include "elastimate/io/printable.h"

namespace elastimate {
namespace {

using nlohmann::json;

/// Characters of the parser's own messages, which quote the text.
constexpr std::size_t kLongestMessage = 160;

/// Without this, the last of several equal keys would silently win.
class RepeatedKeyCheck {
 public:
  RepeatedKeyCheck(const std::filesystem::path& path, std::string& last_key)
      : path_(path), last_key_(last_key) {}

  bool operator()(int /*depth*/, json::parse_event_t event, json& parsed) {
    if (event == json::parse_event_t::object_start) {
      keys_.emplace_back();
    } else if (event == json::parse_event_t::object_end) {
      keys_.pop_back();
    } else if (event == json::parse_event_t::key) {
      last_key_ = parsed.get<std::string>();
      if (!keys_.back().insert(last_key_).second) {
        ThrowInputError(path_, "the key \"" + Printable(last_key_) +
                                   "\" is given twice in one object; remove "
                                   "one");
      }
    }
    return true;
  }

 private:
  const std::filesystem::path& path_;
  std::string& last_key_;
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
  std::string last_key;
  try {
    return json::parse(file, RepeatedKeyCheck(path, last_key));
  } catch (const json::out_of_range& error) {
    // "[json.exception...] number overflow parsing '1e999'"; without a place.
    std::string number = error.what();
    number.erase(0, number.find('\'') + 1);
    number.erase(std::min(number.find('\''), number.size()));
    ThrowInputError(path, "the number " + Printable(number) + " of the key \"" +
                              Printable(last_key) +
                              "\" is beyond the range of a double; correct it");
  } catch (const json::exception& error) {
    // "[json.exception...] parse error at line 3, column 7: ..."
    std::string message = error.what();
    const std::string place = "parse error at ";
    if (const auto found = message.find(place); found != std::string::npos) {
      message.erase(0, found + place.size());
    }
    ThrowInputError(path,
                    Printable(message, kLongestMessage) + "; correct the JSON");
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

long long JsonValue::Integer() const {
  // Beyond its range nlohmann's get wraps around.
  if (!value_->is_number_integer() ||
      (value_->is_number_unsigned() &&
       value_->get<unsigned long long>() > 1000000000000ULL)) {
    Fail("must be an integer");
  }
  return value_->get<long long>();
}

double JsonValue::Number() const {
  if (!value_->is_number()) {
    Fail("must be a number");
  }
  return value_->get<double>();
}

Eigen::Vector3d JsonValue::Vector() const {
  if (!value_->is_array() || value_->size() != 3) {
    Fail("must be a list of 3 numbers");
  }
  const std::vector<JsonValue> items = Items();
  return {items[0].Number(), items[1].Number(), items[2].Number()};
}

}  // namespace elastimate
