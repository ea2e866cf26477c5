#pragma once

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "output/sealed_file.h"

namespace parallux {

inline constexpr FileKind checkpoint_kind = {
    "PLXRUN\r\n", 2, "a checkpoint", "parallux solve --checkpoint", "solve from the beginning"};

/// Writes one checkpoint after the other on a thread of its own, aside from the workers: to be made
/// before them, so that it is not bound to the processor of one.
class CheckpointWriter {
public:
    /// Why one could not be written, "" where it was; none: there is nothing new to tell.
    using Outcome = std::optional<std::string>;

    /// An empty name: nothing will be written.
    explicit CheckpointWriter(std::filesystem::path file);
    /// Waits for what is being written.
    ~CheckpointWriter();
    CheckpointWriter(const CheckpointWriter&) = delete;
    CheckpointWriter& operator=(const CheckpointWriter&) = delete;

    bool busy();
    /// Takes the body of the next one; must not be busy. Returns at once.
    void write(std::string body);
    /// Waits until it is not busy.
    Outcome finish();
    /// Of the last one, once.
    Outcome outcome();

private:
    void work();

    const std::filesystem::path file_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<std::string> body_;  // to be written, or under way
    Outcome outcome_;
    bool closing_ = false;
    std::thread thread_;
};

}  // namespace parallux
