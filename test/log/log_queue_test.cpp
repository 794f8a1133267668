#include "hammer_loads/log/log_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

namespace hammer_loads::test {
namespace {

TEST(LogQueue, HandsOverEveryByteBetweenThreads) {
  LogQueue queue(16384);
  queue.take();
  LogTopic topic(0, "/t", {}, false, "");
  constexpr std::uint32_t kCount = 50000;
  std::thread producer([&] {
    for (std::uint32_t i = 0; i < kCount;) {
      const std::uint32_t size = i * 7 % 600;
      std::uint8_t* bytes = queue.reserve(size);
      if (bytes == nullptr) {
        std::this_thread::yield();
        continue;
      }
      std::fill_n(bytes, size, static_cast<std::uint8_t>(i));
      queue.commit(topic, ros::Time(i + 1, 0));
      ++i;
    }
  });
  std::uint32_t wrong = 0;
  for (std::uint32_t i = 0; i < kCount;) {
    LogQueue::Record* record = queue.front();
    if (record == nullptr) {
      std::this_thread::yield();
      continue;
    }
    wrong += record->topic != &topic || record->time.sec != i + 1 || record->size != i * 7 % 600;
    for (std::uint32_t k = 0; k < record->size; ++k) wrong += record->bytes()[k] != static_cast<std::uint8_t>(i);
    queue.pop();
    ++i;
  }
  producer.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(queue.front(), nullptr);
  EXPECT_EQ(queue.fill(), 0.0);
  EXPECT_EQ(queue.reserve(16384), nullptr);  // never fits
}

}  // namespace
}  // namespace hammer_loads::test
