#include "solve/checkpoint_writer.h"

#include <exception>
#include <utility>

namespace parallux {

CheckpointWriter::CheckpointWriter(std::filesystem::path file) : file_(std::move(file)) {
    if (!file_.empty())
        thread_ = std::thread([this] { work(); });
}

CheckpointWriter::~CheckpointWriter() {
    {
        std::lock_guard lock(mutex_);
        closing_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable())
        thread_.join();
}

bool CheckpointWriter::busy() {
    std::lock_guard lock(mutex_);
    return body_.has_value();
}

void CheckpointWriter::write(std::string body) {
    {
        std::lock_guard lock(mutex_);
        body_ = std::move(body);
    }
    changed_.notify_all();
}

CheckpointWriter::Outcome CheckpointWriter::finish() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !body_; });
    return std::exchange(outcome_, std::nullopt);
}

CheckpointWriter::Outcome CheckpointWriter::outcome() {
    std::lock_guard lock(mutex_);
    return std::exchange(outcome_, std::nullopt);
}

void CheckpointWriter::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [&] { return body_ || closing_; });
        if (!body_)
            return;
        lock.unlock();
        // Nobody else touches the body while it is there.
        std::string failure;
        try {
            SealedFile output(file_, checkpoint_kind, body_->size());
            output(*body_);
            output.commit();
        } catch (const std::exception& error) {
            failure = error.what();
        }
        lock.lock();
        body_.reset();
        outcome_ = failure;
        changed_.notify_all();
    }
}

}  // namespace parallux
