// What the methods of TreeReconstructor that take a while have in common.
#pragma once

#include <cstdint>
#include <godot_cpp/classes/project_settings.hpp>
#include <string>

#include "convert.h"
#include "progress.h"
#include "tree_reconstructor/tree_reconstructor.h"

// Passes the core's progress on.
class TreeReconstructor::Listener : public treerec::Progress {
  public:
    explicit Listener(TreeReconstructor* p_owner) : owner_(p_owner) {}
    void update(double p_fraction, const char* p_stage) override {
        owner_->_report_progress(p_fraction, p_stage);
    }
    void count(size_t p_done, size_t p_all) override { owner_->_report_count(p_done, p_all); }
    bool cancelled() const override { return owner_->cancelled_; }

  private:
    TreeReconstructor* owner_;
};

inline std::string file_path(const godot::String& p_path) {
    return to_std(godot::ProjectSettings::get_singleton()->globalize_path(p_path));
}

// One call at work. A cancel is for the call that is running, or else for the next one, and is over with it.
class TreeReconstructor::Job {
  public:
    explicit Job(TreeReconstructor* p_owner) : owner_(p_owner), owns_(!p_owner->running_.exchange(true)) {
        if (owns_) {
            owner_->_fail("");
            const std::lock_guard lock(owner_->mutex_);
            owner_->fraction_ = 0.0;
            owner_->stage_.clear();
        }
    }
    ~Job() {
        if (owns_) {
            owner_->cache_bytes_ = int64_t(owner_->cache_.bytes());
            owner_->cancelled_ = false;
            owner_->running_ = false;
        }
    }
    Job(const Job&) = delete;
    Job& operator=(const Job&) = delete;

    bool is_alone() const { return owns_; }

  private:
    TreeReconstructor* owner_;
    bool owns_;
};

#define BUSY "This TreeReconstructor is at work already. Make another one."
