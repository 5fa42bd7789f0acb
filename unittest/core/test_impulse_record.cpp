// Sums over spans of time in bounded memory.

#include "impulse_record.h"

#include "vec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <vector>

using namespace Dust;

TEST(ImpulseRecord, KeepsSumsInBoundedMemory)
{
  std::mt19937 random(6);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int steps : {1, 63, 64, 65, 128, 129, 1000, 5000}) {
    ImpulseRecord record;
    Vec impulse, turn;
    double time = 0.0;
    for (int k = 0; k < steps; k++) {
      const Vec a = {u(random), u(random), u(random)}, spin = {u(random), u(random), u(random)};
      const double dt = 1.0 + 0.5 * u(random);
      record.add(&a.x, &spin.x, dt);
      impulse = impulse + dt * a;
      turn = turn + dt * spin;
      time += dt;
      ASSERT_LE(record.spans().size(), size_t(ImpulseRecord::MAX_SPANS));
    }
    EXPECT_GE(record.spans().size(), size_t(std::min(steps, ImpulseRecord::MAX_SPANS / 2)));
    Packer counter;
    record.pack(counter);
    std::vector<double> buf(counter.size());
    Packer packer(buf.data());
    record.pack(packer);
    ImpulseRecord other;
    Unpacker unpacker(buf.data());
    other.unpack(unpacker);
    EXPECT_EQ(unpacker.position(), buf.data() + buf.size());
    ASSERT_EQ(other.spans().size(), record.spans().size());
    EXPECT_EQ(std::memcmp(other.spans().data(), record.spans().data(),
                          record.spans().size() * sizeof(ImpulseRecord::Span)),
              0);
    for (const auto &span : record.spans()) {
      impulse = impulse - Vec{span.impulse[0], span.impulse[1], span.impulse[2]};
      turn = turn - Vec{span.angle[0], span.angle[1], span.angle[2]};
      time -= span.duration;
    }
    EXPECT_NEAR(size(impulse), 0.0, 1e-9);
    EXPECT_NEAR(size(turn), 0.0, 1e-9);
    EXPECT_NEAR(time, 0.0, 1e-9);
  }
}

TEST(ImpulseRecord, SpansAreOfSoManyStepsEach)
{
  for (int steps : {10, 64, 65, 200, 1000, 5000}) {
    ImpulseRecord record;
    const double a[3] = {1.0, 0.0, 0.0}, spin[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < steps; k++) record.add(a, spin, 1.0);
    int length = 1;
    while (steps > length * ImpulseRecord::MAX_SPANS) length *= 2;
    for (size_t k = 0; k + 1 < record.spans().size(); k++) EXPECT_EQ(record.spans()[k].duration, length) << steps;
    EXPECT_LE(record.spans().back().duration, length);
  }
}
