#include "ridgeline/pager/io_thread.h"

#include <algorithm>

#include "ridgeline/base/thread_role.h"
#include "ridgeline/io/store.h"
#include "ridgeline/jobs/job_system.h"
#include "ridgeline/telemetry/recorder.h"
#include "ridgeline/telemetry/trace.h"

namespace ridgeline::pager {
namespace {

// For messages.
const char* first_payload(TileKind kind) {
    constexpr const char* kNames[kTileKinds] = {"mesh", "imagery", "heights tile"};
    return kNames[index(kind)];
}

// Faults of one file must not go with those of another.
constexpr std::uint64_t kHeightsSeed = 0x68656967687473ULL;
constexpr std::uint64_t kImagerySeed = 0x696d6167657279ULL;
FaultSpec reseeded(FaultSpec fault, std::uint64_t seed) {
    fault.seed ^= seed;
    return fault;
}

bool matches(std::span<const std::uint8_t> bytes, const io::PayloadRef& payload) {
    return payload.size == 0 || io::payload_checksum(bytes) == payload.checksum;
}

// The part of a read's bytes that is one payload.
std::span<const std::uint8_t> payload_in(const std::vector<std::uint8_t>& bytes, const ByteRange& range,
                                         const io::PayloadRef& payload) {
    if (payload.size == 0) return {};
    return {bytes.data() + (payload.offset - range.begin), payload.size};
}

}  // namespace

IoThread::IoThread(const TileSource& source, const TileDecoder& decoder, jobs::JobSystem& jobs,
                   RequestBoard& board, const IoThreadOptions& options)
    : source_(source),
      tiles_(source.tiles()),
      decoder_(decoder),
      jobs_(jobs),
      board_(board),
      options_(options),
      trace_(options.recorder ? options.recorder->trace() : nullptr),
      completions_(board.slots()),
      returned_slots_(options.max_decodes),
      slots_(options.max_decodes) {
    files_[index(TileKind::chunk)].first.emplace(*source.mesh, options.fault);
    files_[index(TileKind::chunk)].second.emplace(*source.heights, reseeded(options.fault, kHeightsSeed));
    if (source.imagery.tiles)
        files_[index(TileKind::imagery)].first.emplace(*source.imagery.tiles,
                                                       reseeded(options.fault, kImagerySeed));
    files_[index(TileKind::heights)].first.emplace(*source.heights,
                                                   reseeded(options.fault, kHeightsSeed + 1));
    const LargestPayloads largest = largest_payloads(source);
    const auto limit = static_cast<std::size_t>(options.limits.max_read_bytes);
    first_bytes_.reserve(std::max(limit, largest.first));
    second_bytes_.reserve(std::max(limit, largest.second));
    for (std::uint32_t i = 0; i < slots_.size(); ++i) {
        slots_[i].first.reserve(largest.first);
        slots_[i].second.reserve(largest.second);
        free_slots_.push_back(i);
    }
    batches_.for_each_value([&board](Batch& batch) { batch.reserve(board.slots()); });
    group_.reserve(options.limits.max_members);
    retries_.reserve(2 * board.slots());
    candidates_.reserve(2 * board.slots());
    thread_ = std::thread([this] { run_on_io_thread(); });
}

IoThread::~IoThread() {
    stopping_.store(true);
    for_each_file([](FaultySource& file) { file.interrupt(); });
    returned_slots_.sender().wake();
    thread_.join();
    jobs_.wait(decodes_);
}

IoThread::LargestPayloads IoThread::largest_payloads(const TileSource& source) {
    LargestPayloads largest;
    const NodeIndex count = source.tiles().count();
    for (NodeIndex tile = 0; tile < count; ++tile) {
        const TilePayloads payloads = source.payloads(tile);
        largest.first = std::max<std::size_t>(largest.first, payloads.first.size);
        largest.second = std::max<std::size_t>(largest.second, payloads.second.size);
    }
    return largest;
}

template <class Visit>
void IoThread::for_each_file(Visit visit) {
    for (Files& files : files_)
        for (std::optional<FaultySource>* file : {&files.first, &files.second})
            if (*file) visit(**file);
}

void IoThread::publish() {
    batches_.publish();
    returned_slots_.sender().wake();
}

void IoThread::advance(std::uint32_t frame) {
    for_each_file([frame](FaultySource& file) { file.advance(frame); });
}

IoCounters IoThread::counters(TileKind kind) const {
    const AtomicCounters& counts = counts_[index(kind)];
    return {counts.reads.load(std::memory_order_relaxed), counts.bytes_read.load(std::memory_order_relaxed),
            counts.retried.load(std::memory_order_relaxed)};
}

void IoThread::run_on_io_thread() {
    set_thread_role(ThreadRole::io, "io");
    if (options_.recorder) options_.recorder->count_this_thread(telemetry::CpuGroup::io);
    run_rounds_on_io_thread();
    if (options_.recorder) options_.recorder->release_this_thread();
}

void IoThread::run_rounds_on_io_thread() {
    while (!stopping()) {
        if (Batch* newest = batches_.take()) {
            batch_ = newest;
            next_ = 0;
        }
        if (choose_on_io_thread()) {
            read_on_io_thread();
            continue;
        }
        auto until = Clock::now() + std::chrono::hours(1);
        for (const Reading& retry : retries_) until = std::min(until, retry.due);
        sleep_on_io_thread(until);
    }
}

// Ends early for a new batch, a decode slot that comes back, or the stop.
void IoThread::sleep_on_io_thread(Clock::time_point until) {
    const auto timeout = std::chrono::ceil<std::chrono::microseconds>(until - Clock::now());
    std::uint32_t slot = 0;
    if (returned_slots_.receiver().receive_for(slot, std::max(timeout, std::chrono::microseconds(0))))
        free_slots_.push_back(slot);
}

// --- what to read next

bool IoThread::choose_on_io_thread() {
    group_.clear();
    candidates_.clear();
    return choose_from_retries_on_io_thread() || choose_from_batch_on_io_thread();
}

// Of the first candidate's kind alone: others lie in other files.
void IoThread::add_candidate_on_io_thread(std::uint32_t index, NodeIndex tile) {
    if (candidates_.empty()) reading_ = tiles_.kind(tile);
    if (tiles_.kind(tile) == reading_) candidates_.push_back({index, ReadRanges::of(source_.payloads(tile))});
}

bool IoThread::choose_from_batch_on_io_thread() {
    if (!batch_) return false;
    const auto stands = [&](std::uint32_t i) {
        return board_.state((*batch_)[i].ticket) == TileState::queued;
    };
    const auto count = static_cast<std::uint32_t>(batch_->size());
    while (next_ < count && !stands(next_)) ++next_;
    for (std::uint32_t i = next_; i < count; ++i)
        if (stands(i)) add_candidate_on_io_thread(i, (*batch_)[i].tile);
    if (candidates_.empty()) return false;
    for (const ReadCandidate& member : choose_group(candidates_, options_.limits)) {
        const BatchRequest& request = (*batch_)[member.index];
        if (board_.advance(request.ticket, TileState::queued, TileState::reading))
            group_.push_back({request});
    }
    // All of it may have been cancelled meanwhile; the next round sees to that.
    return true;
}

bool IoThread::choose_from_retries_on_io_thread() {
    std::erase_if(retries_, [&](const Reading& retry) {
        return board_.state(retry.request.ticket) != TileState::reading;
    });
    const auto now = Clock::now();
    const auto head =
        std::find_if(retries_.begin(), retries_.end(), [&](const Reading& r) { return r.due <= now; });
    if (head == retries_.end()) return false;
    // The last attempt reads a tile alone, so that it fails for its own bytes only.
    const bool alone = head->attempts == options_.quick_retries;
    for (auto retry = head; retry != retries_.end(); ++retry)
        if (retry == head || (!alone && retry->due <= now && retry->attempts < options_.quick_retries))
            add_candidate_on_io_thread(static_cast<std::uint32_t>(retry - retries_.begin()),
                                       retry->request.tile);
    for (const ReadCandidate& member : choose_group(candidates_, options_.limits)) {
        group_.push_back(retries_[member.index]);
        retries_[member.index].request.tile = kNoNode;
    }
    std::erase_if(retries_, [](const Reading& retry) { return retry.request.tile == kNoNode; });
    return true;
}

// --- reading

void IoThread::read_on_io_thread() {
    ranges_ = {};
    for (const Reading& reading : group_)
        ranges_ = ranges_.joined(ReadRanges::of(source_.payloads(reading.request.tile)));
    Files& files = files_[index(reading_)];
    auto read = read_range_on_io_thread(files.first, ranges_.first, first_bytes_);
    if (read) read = read_range_on_io_thread(files.second, ranges_.second, second_bytes_);
    for (const Reading& reading : group_) {
        const auto sound = read ? check_on_io_thread(reading.request.tile) : read;
        if (stopping()) return;
        if (sound)
            hand_over_on_io_thread(reading.request);
        else
            retry_or_fail_on_io_thread(reading, sound.error());
    }
}

Result<void> IoThread::read_range_on_io_thread(std::optional<FaultySource>& source, const ByteRange& range,
                                               std::vector<std::uint8_t>& buffer) {
    if (range.empty()) return {};
    AtomicCounters& counts = counts_[index(reading_)];
    const telemetry::TraceScope scope(trace_, "read");
    buffer.resize(static_cast<std::size_t>(range.bytes()));
    counts.reads.fetch_add(1, std::memory_order_relaxed);
    RIDGELINE_TRY(source->read(range.begin, buffer));
    counts.bytes_read.fetch_add(range.bytes(), std::memory_order_relaxed);
    return {};
}

Result<void> IoThread::check_on_io_thread(NodeIndex tile) const {
    const auto [first, second] = source_.payloads(tile);
    if (!matches(payload_in(first_bytes_, ranges_.first, first), first))
        return Error{std::string("the ") + first_payload(reading_) + "'s checksum does not match"};
    if (!matches(payload_in(second_bytes_, ranges_.second, second), second))
        return Error{"the heights' checksum does not match"};
    return {};
}

void IoThread::hand_over_on_io_thread(const BatchRequest& request) {
    if (!wait_for_slot_on_io_thread()) return;
    if (!board_.advance(request.ticket, TileState::reading, TileState::decoding)) return;
    const std::uint32_t free = free_slots_.back();
    free_slots_.pop_back();
    DecodeSlot& slot = slots_[free];
    slot.request = request;
    const TilePayloads payloads = source_.payloads(request.tile);
    const auto first = payload_in(first_bytes_, ranges_.first, payloads.first);
    const auto second = payload_in(second_bytes_, ranges_.second, payloads.second);
    slot.first.assign(first.begin(), first.end());
    slot.second.assign(second.begin(), second.end());
    jobs_.submit([this, free] { decode_on_worker(free); }, &decodes_);
}

// False when stopping.
bool IoThread::wait_for_slot_on_io_thread() {
    while (free_slots_.empty() && !stopping()) sleep_on_io_thread(Clock::now() + std::chrono::hours(1));
    return !stopping();
}

void IoThread::retry_or_fail_on_io_thread(const Reading& reading, const Error& error) {
    if (reading.attempts < options_.quick_retries) {
        counts_[index(reading_)].retried.fetch_add(1, std::memory_order_relaxed);
        const auto pause = options_.first_pause * (1 << (2 * reading.attempts));
        retries_.push_back({reading.request, reading.attempts + 1, Clock::now() + pause});
        return;
    }
    if (!board_.advance(reading.request.ticket, TileState::reading, TileState::failed)) return;
    completions_.sender().send({reading.request.ticket, TileState::failed, Clock::now(), error.message});
}

Result<void> IoThread::decode_on_worker(DecodeSlot& slot) {
    const NodeIndex tile = slot.request.tile;
    const io::NodeId node = tiles_.id(tile);
    if (tiles_.kind(tile) == TileKind::imagery)
        return decoder_.decode_imagery({node, slot.first}, slot.scratch, slot.request.block);
    if (tiles_.kind(tile) == TileKind::heights)
        return decoder_.decode_heights({node, source_.grid.quads(), source_.heights_filter(node), slot.first},
                                       slot.scratch, slot.request.block);
    return decoder_.decode({node, &source_.record(tile), slot.first, slot.second}, slot.scratch,
                           slot.request.block);
}

void IoThread::decode_on_worker(std::uint32_t number) {
    const telemetry::TraceScope scope(trace_, "decode");
    DecodeSlot& slot = slots_[number];
    const auto decoded = decode_on_worker(slot);
    Completion completion{slot.request.ticket, TileState::ready, Clock::now(), {}};
    if (!decoded) {
        completion.outcome = TileState::damaged;
        completion.message = decoded.error().message;
    }
    completions_.sender().send(std::move(completion));
    returned_slots_.sender().send(number);
}

}  // namespace ridgeline::pager
