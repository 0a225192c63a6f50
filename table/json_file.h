// JSON files whose errors name the file and the field: shared by every room that reads one.
//
// A JsonField is a value together with its place, an RFC 6901 JSON pointer. Each reading function
// throws FileError "FILE: POINTER: found .., expected ..", in one line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::table {

/// A value within a JsonFile, which has to outlive it.
class JsonField {
 public:
  JsonField(const nlohmann::ordered_json& value, std::string_view file, std::string pointer);

  /// Where the value stands: "/parameters/alpha_x/value".
  const std::string& pointer() const { return pointer_; }
  bool is_null() const { return value_->is_null(); }
  bool is_array() const { return value_->is_array(); }
  bool is_number() const { return value_->is_number(); }

  /// A member of an object that has to be there.
  JsonField member(std::string_view key) const;
  /// A member of an object, or nothing if it is absent.
  std::optional<JsonField> find(std::string_view key) const;
  /// All members of an object, in the file's order.
  std::vector<std::pair<std::string, JsonField>> members() const;
  /// All elements of an array.
  std::vector<JsonField> elements() const;
  /// Refuses any member of an object that is not named here.
  void allow_only(std::initializer_list<std::string_view> keys) const;

  std::string text() const;
  double number() const;
  /// An integer from 0 to 2^64 - 1.
  std::uint64_t whole_number() const;
  bool flag() const;
  std::vector<double> numbers() const;
  std::vector<std::string> texts() const;

  /// Throws the error that the found value is not the `expected` one.
  [[noreturn]] void expected(std::string_view expected) const;
  /// Throws an error about this field.
  [[noreturn]] void refuse(std::string_view problem) const;

 private:
  const nlohmann::ordered_json* value_;
  std::string_view file_;
  std::string pointer_;
};

/// A parsed JSON file.
class JsonFile {
 public:
  /// Reads and parses the file `path`. Throws FileError.
  static JsonFile read(const std::string& path);
  /// Parses `content`; `path` is for messages. Throws FileError with line and column, also for a
  /// member that stands twice in an object.
  static JsonFile parse(std::string_view content, const std::string& path);

  const std::string& path() const { return path_; }
  /// Throws an error about the field at `pointer`, which need not exist.
  [[noreturn]] void refuse(std::string_view pointer, std::string_view problem) const;
  JsonField root() const { return {document_, path_, ""}; }
  /// Throws unless the document declares `"format": format` and a `"version"` from 1 to `newest`.
  void require_format(std::string_view format, std::uint64_t newest) const;

 private:
  JsonFile(std::string path, nlohmann::ordered_json document)
      : path_(std::move(path)), document_(std::move(document)) {}

  std::string path_;
  nlohmann::ordered_json document_;
};

/// `json` as the text of a file: indented, with a newline at the end. Doubles read back to the
/// same bits; bytes that are not UTF-8 become U+FFFD.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace gonio::table
