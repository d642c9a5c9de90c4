#include "taut/io/text/output_file.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "taut/io/text/whole_file.h"
#include "temporary_folder.h"

namespace taut {
namespace {

using taut_test::content;

class OutputFileTest : public taut_test::TemporaryFolder {};

TEST_F(OutputFileTest, AppearsWholeOrNotAtAll) {
  const auto target = path("a.txt");
  {
    OutputFile file(target);
    file.text("lost");
    file.finish();
  }
  EXPECT_EQ(file_count(), 0U);
  OutputFile file(target);
  file.text("kept");
  file.finish();
  EXPECT_FALSE(std::filesystem::exists(target));
  file.publish();
  EXPECT_EQ(content(target), "kept");
  EXPECT_EQ(file_count(), 1U);
}

/// What was there stays, what was published stays, what is being written goes.
TEST_F(OutputFileTest, IsRemovedWhereTheProcessEnds) {
  std::ofstream(path("before.txt")) << "before";
  const auto write_and_exit = [&] {
    write_whole_file(path("published.txt"), "published");
    OutputFile before(path("before.txt"));
    before.text("after");
    OutputFile finished(path("finished.txt"));
    finished.text("finished");
    finished.finish();
    abandon_files();
    std::_Exit(7);
  };
  EXPECT_EXIT(write_and_exit(), testing::ExitedWithCode(7), "");
  EXPECT_EQ(file_count(), 2U);
  EXPECT_EQ(content(path("before.txt")), "before");
  EXPECT_EQ(content(path("published.txt")), "published");
}

}  // namespace
}  // namespace taut
