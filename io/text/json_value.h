#ifndef ELASTIMATE_IO_TEXT_JSON_VALUE_H_
#define ELASTIMATE_IO_TEXT_JSON_VALUE_H_

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace elastimate {

/// Parses a JSON file.  Throws std::invalid_argument, naming the file, line and
/// column, unless it is one JSON document without repeated keys.
nlohmann::json ParseJsonFile(const std::filesystem::path& path);

/// A value of a JSON file that knows its place in the file, so that an error
/// can be told as "FILE: cases[0].loads[1].surface must be ...".  Every method
/// throws this as std::invalid_argument when the value is not as asked for.
///
/// Views `file` and `value`, which must outlive it.
class JsonValue {
 public:
  JsonValue(const std::filesystem::path& file, const nlohmann::json& value,
            std::string place = "")
      : file_(&file), value_(&value), place_(std::move(place)) {}

  /// Throws unless this is an object all of whose keys are among `keys`.
  void CheckKeys(const std::vector<std::string>& keys) const;

  bool Has(const std::string& key) const { return value_->contains(key); }
  std::size_t NumKeys() const { return value_->size(); }
  JsonValue At(const std::string& key) const;
  std::vector<JsonValue> Items() const;

  bool IsString() const { return value_->is_string(); }
  bool IsList() const { return value_->is_array(); }
  bool IsObject() const { return value_->is_object(); }
  /// JSON does not tell 1.0 from 1.
  bool IsInteger() const;
  bool IsNull() const { return value_->is_null(); }
  std::string String() const;
  long long Integer() const;
  double Number() const;
  bool Boolean() const;
  /// Returns a list of so many numbers.
  Eigen::VectorXd Vector(Eigen::Index size) const;
  /// Returns the number of items of a list; 0 for anything else.
  Eigen::Index ListSize() const;

  /// Returns the value without its place.
  const nlohmann::json& Json() const { return *value_; }

  const std::filesystem::path& File() const { return *file_; }
  const std::string& Place() const { return place_; }

  /// Throws "FILE: PLACE sentence".
  [[noreturn]] void Fail(const std::string& sentence) const;

 private:
  const std::filesystem::path* file_;
  const nlohmann::json* value_;
  std::string place_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_TEXT_JSON_VALUE_H_
