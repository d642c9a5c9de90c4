#include "taut/core/error.h"

#include <gtest/gtest.h>

namespace taut {
namespace {

TEST(Printable, KeepsWhatIsPrintableAndShort) {
  EXPECT_EQ(printable(""), "");
  EXPECT_EQ(printable("Deckfl\xc3\xa4 che \"1\""), "Deckfl\xc3\xa4 che \"1\"");
  EXPECT_EQ(printable(std::string(80, 'x')), std::string(80, 'x'));
}

TEST(Printable, ReplacesControlCharacters) {
  EXPECT_EQ(printable(std::string("a\nb\r\0\x1b[0m\x7f", 10)), "a?b???[0m?");
}

TEST(Printable, CutsBetweenCharacters) {
  EXPECT_EQ(printable(std::string(81, 'x')), std::string(80, 'x') + "...");
  EXPECT_EQ(printable("abc\xc3\xa4", 4), "abc...");
  EXPECT_EQ(printable("abc\xc3\xa4", 5), "abc\xc3\xa4");
  EXPECT_EQ(printable("\xa4\xa4\xa4", 2), "...");
}

}  // namespace
}  // namespace taut
