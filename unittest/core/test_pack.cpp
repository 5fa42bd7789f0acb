// What is packed comes back to the last bit, in the order in which it went.

#include "pack.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
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

// the numbers that they took
size_t expect_back(const std::vector<uint64_t> &words)
{
  Packer counter;
  counter.put_bits(words);
  std::vector<double> numbers(counter.size() + 1, 4.5);    // the last one belongs to another
  Packer to(numbers.data());
  to.put_bits(words);
  EXPECT_EQ(to.size(), counter.size());
  EXPECT_LE(static_cast<size_t>(to.size()), PackedBits::most(words.size()));
  EXPECT_EQ(numbers.back(), 4.5);
  std::vector<uint64_t> back = {7, 7, 7};
  Unpacker from(numbers.data());
  from.get_bits(back);
  EXPECT_EQ(back, words);
  EXPECT_EQ(from.position(), numbers.data() + to.size());
  return to.size();
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

TEST(PackBits, WholeAndEmptyWordsTakeNextToNothing)
{
  EXPECT_EQ(expect_back({}), 1u);
  EXPECT_EQ(expect_back({0}), 2u);
  EXPECT_EQ(expect_back({~uint64_t(0)}), 2u);
  EXPECT_EQ(expect_back({1}), 3u);
  // 45,000 grains: 703 words of 64 and eight bits
  std::vector<uint64_t> words(704, ~uint64_t(0));
  words.back() = 0xff;
  EXPECT_EQ(expect_back(words), 1u + 22u + 1u);
}

TEST(PackBits, MixedWordsTakeWhatTheBoundSays)
{
  for (size_t n : {1, 31, 32, 33, 64, 65}) {
    EXPECT_EQ(expect_back(std::vector<uint64_t>(n, 0x5555)), PackedBits::most(n)) << n;
    EXPECT_EQ(expect_back(std::vector<uint64_t>(n, 0)), 1 + (n + 31) / 32) << n;
  }
}

TEST(PackBits, AnyMixtureComesBack)
{
  std::mt19937_64 random(1);
  for (int i = 0; i < 2000; i++) {
    std::vector<uint64_t> words(random() % 150);
    for (uint64_t &word : words) {
      const uint64_t kind = random() % 4;
      word = kind == 0 ? 0 : kind == 1 ? ~uint64_t(0) : kind == 2 ? random() : uint64_t(1) << random() % 64;
    }
    expect_back(words);
    if (::testing::Test::HasFailure()) FAIL() << "case " << i;
  }
}
