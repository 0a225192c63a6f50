// What a gonio-table is refused for, and in which words.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "table/file_error.h"
#include "table/read.h"
#include "tests/gonio_csv_text.h"
#include "tests/run_gonio.h"

namespace gonio::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// The message with which the content is refused.
std::string refusal(const std::string& content) {
  const TemporaryFolder folder;
  const std::string path = folder.write("t.csv", content);
  try {
    table::read(path);
  } catch (const table::FileError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_TRUE(message.starts_with(path)) << message;
    return message.substr(path.size());
  }
  ADD_FAILURE() << "accepted: " << content;
  return {};
}

TEST(GonioCsv, RefusesBadRowsByLineAndColumn) {
  struct Case {
    std::string row;
    std::string found;
  };
  const std::vector<Case> cases{
      {"10,0,10,0,1", ":6: found 5 fields in '10,0,10,0,1', expected 6"},
      {"10,0,10,0,1,2,3", ":6: found 7 fields"},
      {"10,0,10,0,1,2,,", ":6: found 8 fields"},
      {"10,0,10,0,1.5x,2", ":6: column 'R': found '1.5x', expected a number"},
      {"10,0,10,0,red,2", ":6: column 'R': found 'red', expected a number"},
      {"10,0,10,0,1 2,2", ":6: column 'R': found '1 2', expected a number"},
      {"10,0,10,0,+-1,2", ":6: column 'R': found '+-1', expected a number"},
      {"10,0,10,0,0x10,2", ":6: column 'R': found '0x10', expected a number"},
      {"10,0,10,0,1,nan", ":6: column 'G': found 'nan', expected a finite number"},
      {"10,0,10,0,1,-inf", ":6: column 'G': found '-inf', expected a finite number"},
      {"10,0,10,0,1,1e999", ":6: column 'G': found '1e999', expected a number whose"},
      {"10,inf,10,0,1,2", ":6: column 'phi_i': found 'inf', expected a finite number"},
      {"10,0,10,,1,2", ":6: column 'phi_o': empty, expected an angle"},
      {",0,10,0,1,2", ":6: column 'theta_i': empty, expected an angle"},
      {"-0.5,0,10,0,1,2", ":6: column 'theta_i': found '-0.5', expected 0 to 90 deg"},
      {"10,0,90.00001,0,1,2", ":6: column 'theta_o': found '90.00001', expected 0 to 90 deg"},
      {"10,0,10,0,a\x01\xFF,2", ":6: column 'R': found 'a\\x01\\xFF', expected a number"},
      {"10;0;10;0;1;2", ":6: column 'theta_i': found '10;0;10;0;1;2', expected a number"},
  };
  for (const auto& [row, found] : cases) {
    // A good row in front, and a worse one behind: the bad one is the one that is named.
    EXPECT_THAT(refusal(fmt::format("{}10,0,10,0,1,2\n{}\nworse\n", plain, row)), HasSubstr(found));
  }
  const std::string endless(1000, 'x');
  EXPECT_THAT(refusal(plain + endless + ",0,10,0,1,2\n"),
              HasSubstr("'" + std::string(40, 'x') + "...'"));
}

TEST(GonioCsv, RefusesBadSigmaAndWeight) {
  const std::string start = header("brdf", "deg", "theta_i,phi_i,theta_o,phi_o,R,sigma_R,weight");
  EXPECT_THAT(refusal(start + "1,0,1,0,1,0,1\n"),
              HasSubstr(":5: column 'sigma_R': found '0', expected a standard deviation above 0"));
  EXPECT_THAT(refusal(start + "1,0,1,0,1,-2,1\n"), HasSubstr("column 'sigma_R': found '-2'"));
  EXPECT_THAT(refusal(start + "1,0,1,0,1,,1\n"),
              HasSubstr("column 'sigma_R': empty beside a value"));
  EXPECT_THAT(refusal(start + "1,0,1,0,1,1,-1\n"),
              HasSubstr("column 'weight': found '-1', expected a weight of at least 0"));
  EXPECT_THAT(refusal(start + "1,0,1,0,1,1,\n"), HasSubstr("column 'weight': empty"));
  // Where the quantity tells no f_r, at the horizon, too.
  EXPECT_THAT(refusal(header("brdf_cos", "deg", "theta_i,phi_i,theta_o,phi_o,R,sigma_R") +
                      "90,0,1,0,1,0\n"),
              HasSubstr("column 'sigma_R': found '0'"));
}

TEST(GonioCsv, RefusesValuesWhoseBrdfOverflows) {
  EXPECT_THAT(refusal(header("brdf_cos", "deg", "theta_i,phi_i,theta_o,phi_o,R") +
                      "89.9999,0,10,0,1e308\n"),
              HasSubstr(":5: column 'R': found '1e308', expected a number whose f_r"));
}

TEST(GonioCsv, RefusesBadColumnsByName) {
  const auto columns = [](const std::string& names) {
    return refusal(header("brdf", "deg", names) + "1,2,3,4,5,6,7\n");
  };
  EXPECT_THAT(columns("theta_i,phi_i,theta_o,R,G"), HasSubstr(":4: no column 'phi_o'"));
  EXPECT_THAT(columns("theta_i,phi_i,theta_o,phi_o,R,R"),
              HasSubstr(":4: columns 5 and 6 are both named 'R'"));
  EXPECT_THAT(columns("theta_i,phi_i,theta_o,phi_o,theta_i,R"),
              HasSubstr(":4: columns 1 and 5 are both named 'theta_i'"));
  EXPECT_THAT(columns("theta_i,phi_i,theta_o,phi_o"), HasSubstr(":4: no channel"));
  EXPECT_THAT(columns("theta_i,phi_i,theta_o,phi_o,weight"), HasSubstr(":4: no channel"));
  EXPECT_THAT(columns("theta_i,phi_i,theta_o,phi_o,R,sigma_G"),
              HasSubstr(":4: column 'sigma_G' is the sigma of no channel"));
  EXPECT_THAT(columns("theta_i,phi_i,theta_o,phi_o,R,G,sigma_G"),
              HasSubstr(":4: channel 'R' has no column 'sigma_R'"));
  EXPECT_THAT(columns("theta_i,phi_i,theta_o,phi_o,,R"), HasSubstr(":4: column 5 has no name"));
  EXPECT_THAT(columns("theta_i;phi_i;theta_o;phi_o;R"),
              HasSubstr("separate columns by commas, not semicolons"));
}

TEST(GonioCsv, RefusesAHeaderThatDoesNotSayWhatTheNumbersAre) {
  const std::string rows = "theta_i,phi_i,theta_o,phi_o,R\n1,2,3,4,5\n";
  EXPECT_THAT(refusal(rows), AllOf(HasSubstr("'# gonio-table 1'"), HasSubstr("'# quantity: brdf'"),
                                   HasSubstr("'# angles: deg'"), HasSubstr("--quantity"),
                                   HasSubstr("--angles"), HasSubstr("--columns")));
  EXPECT_THAT(refusal("# gonio-table 1\n# angles: deg\n" + rows), HasSubstr("'# quantity: brdf'"));
  EXPECT_THAT(refusal("# gonio-table 1\n# quantity: brdf\n" + rows), HasSubstr("'# angles: deg'"));
  EXPECT_THAT(refusal("# gonio-table 1\n# quantity: radiance\n# angles: deg\n" + rows),
              HasSubstr(":2: unknown quantity 'radiance': expected one of brdf, brdf_cos"));
  EXPECT_THAT(refusal("# gonio-table 1\n# quantity: brdf\n# angles: gon\n" + rows),
              HasSubstr(":3: unknown angles 'gon': expected one of deg, rad"));
  EXPECT_THAT(
      refusal("# gonio-table 1\n# quantity: brdf\n# quantity: brdf_cos\n# angles: deg\n" + rows),
      HasSubstr(":3: a second '# quantity:' line"));
  EXPECT_THAT(refusal("# gonio-table 2\n# quantity: brdf\n# angles: deg\n" + rows),
              HasSubstr(":1: gonio-table 2 is newer"));
  EXPECT_THAT(refusal("# gonio-table\n# quantity: brdf\n# angles: deg\n" + rows),
              HasSubstr(":1: the version of the gonio-table is ''"));
  EXPECT_THAT(refusal("# gonio-table 1\n# quantity: brdf\n# angles: deg\n"),
              HasSubstr("no line of column names"));
  EXPECT_THAT(refusal(plain + "# only a comment\n\n"), HasSubstr("no row of numbers"));
}

}  // namespace
}  // namespace gonio::tests
