#include "table/formats/zemax_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <optional>
#include <utility>

#include "table/file_error.h"
#include "table/formats/text_lines.h"
#include "table/formats/zemax_lines.h"

namespace gonio::table {

namespace {

// The header ---------------------------------------------------------------------------------

/// A list of angles that the header declares.
struct AngleList {
  std::string_view keyword;
  double least, largest;  // degrees
  std::vector<double> ZemaxText::*angles;
};

constexpr double turn = 360;
constexpr std::array<AngleList, 4> angle_lists{{
    {.keyword = "SampleRotation", .least = -turn, .largest = turn, .angles = &ZemaxText::rotations},
    {.keyword = "AngleOfIncidence", .least = 0, .largest = 90, .angles = &ZemaxText::incidences},
    {.keyword = "ScatterAzimuth", .least = -turn, .largest = turn, .angles = &ZemaxText::azimuths},
    {.keyword = "ScatterRadial", .least = 0, .largest = 180, .angles = &ZemaxText::radials},
}};
constexpr double angle_slack = 1e-6;  // degrees

void require_ascending(const std::vector<double>& angles, const ZemaxLines& lines,
                       std::string_view keyword) {
  const auto fall = std::adjacent_find(angles.begin(), angles.end(), std::greater_equal<>());
  if (fall != angles.end()) {
    lines.fail(
        fmt::format("{}: {} deg follows {} deg, expected ascending angles: put them in order",
                    keyword, fall[1], fall[0]));
  }
  if (angles.back() - angles.front() > turn + angle_slack) {
    lines.fail(fmt::format("{}: from {} to {} deg, expected no more than a turn: remove repeats",
                           keyword, angles.front(), angles.back()));
  }
}

/// The list behind its keyword, which stands in view: its count and, on the same or the next
/// lines, its angles.
std::vector<double> take_angles(ZemaxLines& lines, const AngleList& list) {
  std::string_view text = behind_first_word(lines.line());
  if (text.empty()) lines.fail_to_find("the number of angles behind it", "add it");
  double count = 0;
  if (!take_number(text, count)) lines.fail_for_number(text, list.keyword);
  if (count < 1 || count != std::floor(count)) {
    lines.fail(fmt::format("{}: {} angles, expected a whole number from 1 on: correct it",
                           list.keyword, count));
  }
  std::vector<double> angles;
  while (static_cast<double>(angles.size()) < count) {
    if (text.empty()) {
      lines.pass();
      text = lines.line();
      if (lines.at_end() || is_keyword_line(text)) {
        lines.fail_to_find(
            fmt::format("{} angles of {} in all, {} were read", count, list.keyword, angles.size()),
            "correct the count or the list");
      }
    }
    double& angle = angles.emplace_back();
    if (!take_number(text, angle)) lines.fail_for_number(text, list.keyword);
    if (angle < list.least - angle_slack || angle > list.largest + angle_slack) {
      lines.fail(fmt::format("{}: {} deg, expected {} to {} deg: correct it", list.keyword, angle,
                             list.least, list.largest));
    }
  }
  if (!text.empty()) {
    lines.fail(
        fmt::format("{}: {} follows {} angles, as many as it declares: correct the count or "
                    "the list",
                    list.keyword, quoted(text), count));
  }
  require_ascending(angles, lines, list.keyword);
  return angles;
}

/// What the header says beside the lists.
struct Words {
  std::optional<std::string> symmetry, content, type;
};

void take_word(ZemaxLines& lines, std::optional<std::string>& word, std::string_view keyword) {
  if (word) lines.fail(fmt::format("{} stands twice: remove one of them", keyword));
  word = first_word(behind_first_word(lines.line()));
  const auto require = [&](std::initializer_list<std::string_view> known, const char* expected,
                           const char* advice) {
    if (std::find(known.begin(), known.end(), *word) != known.end()) return;
    lines.fail_to_find(fmt::format("{} {}", keyword, expected), advice);
  };
  if (keyword == "Symmetry") {
    require({"planesymmetrical", "asymmetrical", "asymmetrical4d"},
            "PlaneSymmetrical, Asymmetrical or Asymmetrical4D", "correct it");
  } else if (keyword == "SpectralContent") {
    require({"monochrome", "xyz"}, "Monochrome or XYZ", "correct it");
  } else {
    require({"brdf"}, "BRDF", "name a file of reflection, not of transmission");
  }
}

/// Takes the line in view if it belongs to the header.
bool take_header_line(ZemaxLines& lines, ZemaxText& result, Words& words) {
  const std::string word = first_word(lines.line());
  for (const AngleList& list : angle_lists) {
    if (word != first_word(list.keyword)) continue;
    std::vector<double>& angles = result.*list.angles;
    if (!angles.empty()) {
      lines.fail(fmt::format("{} stands twice: remove one of them", list.keyword));
    }
    angles = take_angles(lines, list);
    return true;
  }
  if (word == "symmetry") {
    take_word(lines, words.symmetry, "Symmetry");
  } else if (word == "spectralcontent") {
    take_word(lines, words.content, "SpectralContent");
  } else if (word == "scattertype") {
    take_word(lines, words.type, "ScatterType");
  } else {
    return word == "source";
  }
  return true;
}

/// Takes all of the header; the first line behind it is in view then.
Words take_header(ZemaxLines& lines, ZemaxText& result) {
  Words words;
  while (!lines.at_end() && take_header_line(lines, result, words)) lines.pass();
  const auto require = [&](bool is_there, std::string_view keyword) {
    if (is_there) return;
    lines.fail_to_find(fmt::format("the keyword {} before the data", keyword), "add it");
  };
  require(words.symmetry.has_value(), "Symmetry");
  require(words.content.has_value(), "SpectralContent");
  require(words.type.has_value(), "ScatterType");
  for (const AngleList& list : angle_lists) {
    require(!(result.*list.angles).empty(), list.keyword);
  }
  return words;
}

// The blocks ---------------------------------------------------------------------------------

/// The number of values of a block. What the text cannot hold is refused before it is allocated.
std::size_t count_values(const ZemaxLines& lines, const ZemaxText& text) {
  constexpr std::size_t least_bytes = 2;  // of a value: a digit and what separates it
  const std::size_t most = lines.bytes_left() / least_bytes + 1;
  std::size_t count = 1;
  for (const AngleList& list : angle_lists) {
    const std::size_t factor = (text.*list.angles).size();
    if (factor > most / count) {
      lines.fail(fmt::format(
          "the lists declare {} x {} x {} x {} values, more than the rest of the file can hold: "
          "correct them or complete the file",
          text.rotations.size(), text.incidences.size(), text.azimuths.size(),
          text.radials.size()));
    }
    count *= factor;
  }
  return count;
}

/// Where in the data a line stands.
struct Block {
  double rotation, incidence;
  std::string name() const {
    return fmt::format("the data of rotation {} and incidence {}", rotation, incidence);
  }
  std::string row_name(double azimuth) const {
    return fmt::format("azimuth {} in {}", azimuth, name());
  }
};

/// The total scatter is a number that nothing is made of: what it integrates differs.
void take_total_scatter(ZemaxLines& lines, const Block& block) {
  if (first_word(lines.line()) != "tis") {
    lines.fail_to_find(fmt::format("TIS and its value before {}", block.name()),
                       "complete the data, or correct the counts of the lists");
  }
  std::string_view text = behind_first_word(lines.line());
  double value = 0;
  if (!take_number(text, value)) lines.fail_for_number(text, "TIS");
  if (!text.empty()) lines.fail_to_find("one number behind TIS", "remove the others");
  lines.pass();
}

void take_row(ZemaxLines& lines, const Block& block, double azimuth, std::size_t count,
              double* values) {
  std::string_view text = lines.line();
  if (lines.at_end() || is_keyword_line(text)) {
    lines.fail_to_find(fmt::format("{} values for {}", count, block.row_name(azimuth)),
                       "complete the data, or correct the counts of the lists");
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (text.empty()) {
      lines.fail(fmt::format("{}: found {} values, expected {}: complete the row",
                             block.row_name(azimuth), i, count));
    }
    if (!take_number(text, values[i])) lines.fail_for_number(text, block.row_name(azimuth));
  }
  if (!text.empty()) {
    lines.fail(fmt::format("{}: {} follows {} values, as many as ScatterRadial declares: remove it",
                           block.row_name(azimuth), quoted(text), count));
  }
  lines.pass();
}

std::vector<double> take_block(ZemaxLines& lines, const ZemaxText& text) {
  lines.pass();
  if (first_word(lines.line()) != "databegin") lines.fail_to_find("DataBegin", "add it");
  lines.pass();
  std::vector<double> values(count_values(lines, text));
  double* at = values.data();
  for (const double rotation : text.rotations) {
    for (const double incidence : text.incidences) {
      const Block block{.rotation = rotation, .incidence = incidence};
      take_total_scatter(lines, block);
      for (const double azimuth : text.azimuths) {
        take_row(lines, block, azimuth, text.radials.size(), at);
        at += text.radials.size();
      }
    }
  }
  if (first_word(lines.line()) != "dataend") {
    lines.fail_to_find("DataEnd behind the last row",
                       "complete the file, or remove what is too much");
  }
  lines.pass();
  return values;
}

/// The channels by the names that their blocks have in the file.
struct ChannelBlock {
  std::string_view block, channel;
};

std::vector<ChannelBlock> channel_blocks(const std::string& content) {
  if (content == "monochrome") return {{"Monochrome", "mono"}};
  return {{"TristimulusX", "X"}, {"TristimulusY", "Y"}, {"TristimulusZ", "Z"}};
}

/// The block's name as it may be written: "Tristimulus X", "TRISTIMULUSX".
std::string without_blanks(std::string_view line) {
  std::string word(line);
  word.erase(std::remove_if(word.begin(), word.end(), is_blank), word.end());
  return first_word(word);
}

void take_blocks(ZemaxLines& lines, const std::vector<ChannelBlock>& blocks, ZemaxText& text) {
  text.values.resize(blocks.size());
  for (std::size_t taken = 0; taken < blocks.size(); ++taken) {
    const std::string word = without_blanks(lines.line());
    const auto found = std::find_if(blocks.begin(), blocks.end(), [&](const ChannelBlock& block) {
      return word == first_word(block.block);
    });
    const auto c = static_cast<std::size_t>(found - blocks.begin());
    if (found == blocks.end() || !text.values[c].empty()) {
      const auto missing = std::find_if(text.values.begin(), text.values.end(),
                                        [](const auto& values) { return values.empty(); });
      lines.fail_to_find(
          fmt::format("the data of {}",
                      blocks[static_cast<std::size_t>(missing - text.values.begin())].block),
          "SpectralContent says which blocks there are: add it, or correct that");
    }
    text.values[c] = take_block(lines, text);
  }
  if (!lines.at_end()) lines.fail_to_find("nothing behind the data", "remove it");
}

}  // namespace

ZemaxText parse_zemax(std::string_view content, const std::string& path) {
  ZemaxLines lines(without_byte_order_mark(content), path);
  ZemaxText text;
  const Words words = take_header(lines, text);
  // A file may list both sides although they are alike.
  text.is_one_sided = words.symmetry == "planesymmetrical" &&
                      text.azimuths.front() >= -angle_slack &&
                      text.azimuths.back() <= turn / 2 + angle_slack;
  const std::vector<ChannelBlock> blocks = channel_blocks(*words.content);
  for (const ChannelBlock& block : blocks) text.channels.emplace_back(block.channel);
  take_blocks(lines, blocks, text);
  text.name = lines.sample_name();
  return text;
}

}  // namespace gonio::table
