// Result<T>: a value or an Error with a message that a user can act on.
//
// Bad input (files, options, data) travels as a Result; a broken contract stops the program (contract.h).
// Nothing in Ridgeline throws across rooms: exceptions of libraries are caught where the library is called.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "ridgeline/base/contract.h"

namespace ridgeline {

// What went wrong, as "WHAT: WHY": names the file and, where it helps, the mend. One line, no trailing stop.
struct Error {
    std::string message;
};

template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }

    T& value() & { return RIDGELINE_CHECK(ok()), std::get<0>(state_); }
    const T& value() const& { return RIDGELINE_CHECK(ok()), std::get<0>(state_); }
    T&& value() && { return RIDGELINE_CHECK(ok()), std::get<0>(std::move(state_)); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }

    const Error& error() const { return RIDGELINE_CHECK(!ok()), std::get<1>(state_); }

  private:
    std::variant<T, Error> state_;
};

template <>
class [[nodiscard]] Result<void> {
  public:
    Result() = default;
    Result(Error error) : error_(std::move(error)) {}

    bool ok() const { return !error_; }
    explicit operator bool() const { return ok(); }
    const Error& error() const { return RIDGELINE_CHECK(!ok()), *error_; }

  private:
    std::optional<Error> error_;
};

// Returns the error of `expression` from the calling function, if it has one.
#define RIDGELINE_TRY(expression)                                            \
    do {                                                                     \
        if (auto ridgeline_try_result = (expression); !ridgeline_try_result) \
            return ::ridgeline::Error{ridgeline_try_result.error()};         \
    } while (false)

}  // namespace ridgeline
