#include "hammer_loads/ros/bag_messages.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace hammer_loads {

BagMessages::BagMessages(const std::vector<std::unique_ptr<BagFile>>& bags, const BagQuery& query,
                         const ChunkQuery& chunks) {
  for (const auto& bag : bags) {
    Source source{bag.get(), {}};
    for (const auto& [id, connection] : bag->connections()) {
      if (query(connection)) source.wanted.emplace(id, &connection);
    }
    for (const BagChunk& chunk : bag->chunks()) {
      if (chunks && !chunks(chunk)) continue;
      std::uint64_t count = 0;
      for (const auto& [id, messages] : chunk.counts) count += source.wanted.count(id) * messages;
      if (count > 0) places_.push_back({&chunk, sources_.size()});
      size_ += count;
    }
    sources_.push_back(std::move(source));
  }
  std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
    return std::tie(a.chunk->first, a.source, a.chunk->position) <
           std::tie(b.chunk->first, b.source, b.chunk->position);
  });
}

bool BagMessages::isLater(const std::unique_ptr<OpenChunk>& a, const std::unique_ptr<OpenChunk>& b) {
  return std::tie(a->message().time, a->place) > std::tie(b->message().time, b->place);
}

void BagMessages::open(std::size_t place) {
  if (spare_.empty()) spare_.push_back(std::make_unique<OpenChunk>());
  std::unique_ptr<OpenChunk> chunk = std::move(spare_.back());
  spare_.pop_back();
  const Source& source = sources_[places_[place].source];
  source.bag->read(*places_[place].chunk, source.wanted, chunk->read);
  chunk->place = place;
  chunk->at = 0;
  if (chunk->read.messages.empty()) return spare_.push_back(std::move(chunk));
  open_.push_back(std::move(chunk));
  std::push_heap(open_.begin(), open_.end(), isLater);
}

void BagMessages::passMessage() {
  std::pop_heap(open_.begin(), open_.end(), isLater);
  if (++open_.back()->at < open_.back()->read.messages.size())
    return std::push_heap(open_.begin(), open_.end(), isLater);
  spare_.push_back(std::move(open_.back()));
  open_.pop_back();
}

const BagMessage* BagMessages::next() {
  if (given_) passMessage();
  given_ = false;
  while (next_place_ < places_.size() &&
         (open_.empty() || places_[next_place_].chunk->first <= open_.front()->message().time))
    open(next_place_++);
  if (open_.empty()) return nullptr;
  given_ = true;
  return &open_.front()->message();
}

}  // namespace hammer_loads
