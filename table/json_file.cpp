#include "table/json_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "table/file_error.h"
#include "table/input_file.h"

namespace gonio::table {
namespace {

using nlohmann::ordered_json;

std::string dump(const ordered_json& value) {
  return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

/// What stands in the file, short enough for a message of one line.
std::string found(const ordered_json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  constexpr std::size_t longest = 60;
  std::string text = dump(value);
  if (text.size() <= longest) return text;
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end) + "...";
}

[[noreturn]] void refuse_field(std::string_view file, std::string_view pointer,
                               std::string_view problem) {
  throw FileError(
      fmt::format("{}: {}: {}", file, pointer.empty() ? "the document" : pointer, problem));
}

/// A key as a reference token of a JSON pointer (RFC 6901, section 3).
std::string escaped(std::string_view key) {
  std::string token;
  for (const char c : key) {
    if (c == '~') {
      token += "~0";
    } else if (c == '/') {
      token += "~1";
    } else {
      token += c;
    }
  }
  return token;
}

std::string line_and_column(std::string_view content, std::size_t offset) {
  const std::string_view before = content.substr(0, std::min(offset, content.size()));
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
  return fmt::format("line {}, column {}", line, before.size() - line_start + 1);
}

/// The parser's own words, without its code and without the bytes that it stumbled over.
std::string parser_reason(std::string_view what) {
  const std::size_t dash = what.find(" - ");
  std::string_view reason = dash == std::string_view::npos ? what : what.substr(dash + 3);
  reason = reason.substr(0, reason.find("; last read"));
  std::string clean(reason);
  std::replace_if(
      clean.begin(), clean.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return clean;
}

/// Refuses a member that stands twice in one object: which of them is meant, nobody can know.
class DuplicateKeys {
 public:
  explicit DuplicateKeys(const std::string& path) : path_(path) {}

  void on_event(int depth, ordered_json::parse_event_t event, const ordered_json& parsed) {
    const auto level = static_cast<std::size_t>(depth);
    if (event == ordered_json::parse_event_t::object_start) {
      if (keys_.size() < level + 2) keys_.resize(level + 2);
      keys_[level + 1].clear();
    } else if (event == ordered_json::parse_event_t::key) {
      if (!keys_[level].insert(parsed.get<std::string>()).second) {
        throw FileError(fmt::format(
            "{}: the member {} stands twice in one object, expected it once: remove one of them",
            path_, found(parsed)));
      }
    }
  }

 private:
  const std::string& path_;
  std::vector<std::set<std::string>> keys_;
};

}  // namespace

JsonField::JsonField(const ordered_json& value, std::string_view file, std::string pointer)
    : value_(&value), file_(file), pointer_(std::move(pointer)) {}

void JsonField::refuse(std::string_view problem) const { refuse_field(file_, pointer_, problem); }

void JsonField::expected(std::string_view what) const {
  refuse(fmt::format("found {}, expected {}", found(*value_), what));
}

JsonField JsonField::member(std::string_view key) const {
  const auto field = find(key);
  if (!field) refuse(fmt::format("the member \"{}\" is missing: add it", key));
  return *field;
}

std::optional<JsonField> JsonField::find(std::string_view key) const {
  if (!value_->is_object()) expected("an object");
  const auto position = value_->find(key);
  if (position == value_->end()) return std::nullopt;
  return JsonField(*position, file_, pointer_ + "/" + escaped(key));
}

std::vector<std::pair<std::string, JsonField>> JsonField::members() const {
  if (!value_->is_object()) expected("an object");
  std::vector<std::pair<std::string, JsonField>> result;
  for (const auto& [key, value] : value_->items()) {
    result.emplace_back(key, JsonField(value, file_, pointer_ + "/" + escaped(key)));
  }
  return result;
}

std::vector<JsonField> JsonField::elements() const {
  if (!value_->is_array()) expected("an array");
  std::vector<JsonField> result;
  for (std::size_t i = 0; i < value_->size(); ++i) {
    result.emplace_back((*value_)[i], file_, fmt::format("{}/{}", pointer_, i));
  }
  return result;
}

void JsonField::allow_only(std::initializer_list<std::string_view> keys) const {
  for (const auto& [key, field] : members()) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      field.refuse(fmt::format("unknown member, expected one of {}: correct or remove it",
                               fmt::join(keys, ", ")));
    }
  }
}

std::string JsonField::text() const {
  if (!value_->is_string()) expected("a text in quotes");
  return value_->get<std::string>();
}

double JsonField::number() const {
  if (!value_->is_number()) expected("a number");
  return value_->get<double>();
}

std::uint64_t JsonField::whole_number() const {
  if (!value_->is_number_unsigned()) expected("a whole number, 0 or more");
  return value_->get<std::uint64_t>();
}

bool JsonField::flag() const {
  if (!value_->is_boolean()) expected("true or false");
  return value_->get<bool>();
}

std::vector<double> JsonField::numbers() const {
  std::vector<double> result;
  for (const JsonField& element : elements()) result.push_back(element.number());
  return result;
}

std::vector<std::string> JsonField::texts() const {
  std::vector<std::string> result;
  for (const JsonField& element : elements()) result.push_back(element.text());
  return result;
}

JsonFile JsonFile::read(const std::string& path) {
  const InputFile file(path);
  return parse(file.bytes(), path);
}

JsonFile JsonFile::parse(std::string_view content, const std::string& path) {
  DuplicateKeys duplicates(path);
  try {
    return {path, ordered_json::parse(content, [&](int depth, ordered_json::parse_event_t event,
                                                   ordered_json& parsed) {
              duplicates.on_event(depth, event, parsed);
              return true;
            })};
  } catch (const ordered_json::parse_error& error) {
    const std::size_t offset = error.byte == 0 ? 0 : error.byte - 1;
    throw FileError(fmt::format("{}: {}: not JSON ({}): correct the file there", path,
                                line_and_column(content, offset), parser_reason(error.what())));
  } catch (const ordered_json::out_of_range& error) {
    const std::string_view what = error.what();
    const std::size_t quote = what.find('\'') + 1;
    const std::string_view number = what.substr(quote, what.rfind('\'') - quote);
    throw FileError(fmt::format("{}: {}: found the number {}, expected one that fits a double",
                                path, line_and_column(content, content.find(number)), number));
  }
}

void JsonFile::refuse(std::string_view pointer, std::string_view problem) const {
  refuse_field(path_, pointer, problem);
}

void JsonFile::require_format(std::string_view format, std::uint64_t newest) const {
  const JsonField word = root().member("format");
  if (word.text() != format) word.expected(fmt::format("\"{}\": is this the right file?", format));
  const JsonField version = root().member("version");
  const std::uint64_t number = version.whole_number();
  if (number < 1) version.expected(fmt::format("a version from 1 to {}", newest));
  if (number > newest) {
    version.refuse(fmt::format("found version {}, this gonio reads up to {}: use a newer gonio",
                               number, newest));
  }
}

std::string json_text(const ordered_json& json) {
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace gonio::table
