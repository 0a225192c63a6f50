// Lines of a text: walking over them, trimming them, and showing a piece of one in a message.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace gonio::table {

/// A blank within a line; the carriage return of a CRLF line end counts as one.
constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// `text` without blanks at either end.
std::string_view trimmed(std::string_view text);

/// `text` without a UTF-8 byte order mark.
std::string_view without_byte_order_mark(std::string_view text);

/// `text` in single quotes, shortened and with unprintable bytes as \xNN: fit for a message.
std::string quoted(std::string_view text);

/// Walks over the lines of a text, counted from 1.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {}

  /// Sets `line` to the next line, trimmed; false at the end of the text.
  bool next(std::string_view& line);
  /// The number of the line that next() gave.
  std::size_t number() const { return number_; }
  /// The text after that line.
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

}  // namespace gonio::table
