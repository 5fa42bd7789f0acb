// What is packed comes back to the last bit, in the order in which it went.

#include "pack.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

using namespace Dust;

namespace {

struct Record {
  double x[3];
  uint64_t bits;
};

void write(Packer &packer, const Record &record, const std::vector<uint64_t> &words)
{
  packer.put(-0.0);
  packer.put(&record, 1);
  packer.put(words);
  packer.put(std::vector<double>());
  packer.put(7.0);
}

}    // namespace

TEST(Pack, EveryBitComesBackAndTheCountIsTheSize)
{
  // bits that are no number, as attachment bits may be
  const Record record = {{1.0 / 3.0, std::numeric_limits<double>::infinity(), -0.0}, 0x7ff00000deadbeef};
  const std::vector<uint64_t> words = {~uint64_t(0), 1, 0xfff8000000000001};
  Packer counter;
  write(counter, record, words);
  EXPECT_EQ(counter.size(), 1 + 4 + (1 + 3) + 1 + 1);
  std::vector<double> buffer(counter.size() + 1, 42.0);
  Packer packer(buffer.data());
  write(packer, record, words);
  EXPECT_EQ(packer.size(), counter.size());
  EXPECT_EQ(buffer.back(), 42.0);    // nothing beyond

  Unpacker unpacker(buffer.data());
  EXPECT_TRUE(std::signbit(unpacker.number()));
  Record back;
  unpacker.get(&back, 1);
  for (int d = 0; d < 3; d++) EXPECT_EQ(back.x[d], record.x[d]);
  EXPECT_TRUE(std::signbit(back.x[2]));
  EXPECT_EQ(back.bits, record.bits);
  std::vector<uint64_t> words_back(17);
  unpacker.get(words_back);
  EXPECT_EQ(words_back, words);
  std::vector<double> none(3);
  unpacker.get(none);
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(unpacker.number(), 7.0);
  EXPECT_EQ(unpacker.position(), buffer.data() + counter.size());
}
