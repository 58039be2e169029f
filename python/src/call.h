// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "record.h"
#include "turns.h"
#include <fresco/core/progress.h>
#include <functional>
#include <mutex>
namespace fresco::python {
/// An argument that stands ahead of the options.
struct Argument {
  const char* name;
  std::string type;                    ///< as in the stubs
  const char* default_value = nullptr; ///< as it is written in Python; null: it must be given
};

/// What a function of the module is called and takes.
struct Function {
  const char* name;
  const char* core; ///< the function of C++ whose comment is the documentation; empty = `note` is all of it
  std::vector<Argument> arguments;
  std::string result;
  const char* note = "";    ///< what the comment of C++ does not say
  bool has_progress = true; ///< whether it takes `progress`
};

/// A keyword that stands for a field of an options struct.
struct Option {
  std::string name, type, default_value, text;
};

/// A value of C++ that stands on memory of Python.
template <typename T>
class Lent {
public:
  Lent(py::handle value, const std::string& name) { Convert<T>::fill(value_, value, name, lender_); }
  const T& operator*() const { return value_; }
  const T* operator->() const { return &value_; }

private:
  T value_{};
  Lender lender_; // gives back before the value ends
};

/// Thrown for Python's FileError.
struct FileTrouble : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A call from Python under way.
class Call {
public:
  /// @throws py::type_error if an argument is missing, given twice or unknown
  Call(const Function& function, const std::vector<Option>& options, const py::args& values, const py::kwargs& named);

  py::object operator[](const char* argument) const { return arguments_[argument]; }
  template <typename T>
  Lent<T> lend(const char* argument) const
  {
    return Lent<T>(arguments_[argument], argument);
  }
  template <typename T>
  T value(const char* argument) const
  {
    T value{};
    Lender lender;
    Convert<T>::fill(value, arguments_[argument], argument, lender);
    return value;
  }
  /// The struct with what was given as keywords.
  template <typename Options>
  Options options() const
  {
    Options options;
    Lender lender; // options hold no arrays
    Fields<Options>::visit([&](const char* name, auto member, const char*) {
      if (named_.contains(name) && !(isUnset(options.*member) && named_[name].is_none()))
        Convert<std::decay_t<decltype(options.*member)>>::fill(options.*member, named_[name], name, lender);
    });
    return options;
  }

  /// body(progress) without the GIL. A signal or an exception of Python's `progress` ends it and comes out here.
  template <typename Body>
  auto compute(const Body& body) const
  {
    Listener listener(named_.contains("progress") ? py::object(named_["progress"]) : py::none());
    const auto finish = [&listener] { listener.rethrow(); };
    try {
      auto result = released([&] { return body(listener.progress()); });
      finish();
      return result;
    } catch (const Cancelled&) {
      finish();
      throw;
    }
  }
  /// The same with the result in Python.
  template <typename Body>
  py::object run(const Body& body) const
  {
    return toPython(compute(body));
  }
  /// body() without the GIL, for what reads or writes files.
  template <typename Body>
  static auto access(const Body& body)
  {
    try {
      return released(body);
    } catch (const Cancelled&) {
      throw;
    } catch (const std::runtime_error& error) {
      throw FileTrouble(error.what());
    }
  }

private:
  /// Hears the progress of the core, on whichever thread, and keeps what went wrong in Python.
  class Listener {
  public:
    explicit Listener(py::object callable);
    Progress progress();
    void rethrow();

  private:
    bool hear(std::string_view step, double fraction);
    py::object callable_;
    std::optional<py::error_already_set> error_;
  };

  template <typename Body>
  static auto released(const Body& body)
  {
    const Turn::Pause pause;
    return body();
  }

  py::dict arguments_, named_;
};

using CallBody = std::function<py::object(const Call&)>;

/// Adds a function, its documentation and its line in the stubs.
void addFunction(const py::module_& module, const Function& function, const std::vector<Option>& options,
                 const std::string& options_text, const CallBody& body);

/// The same with the fields of `Options` as keywords.
template <typename Options>
void addFunction(const py::module_& module, const Function& function, const CallBody& body)
{
  std::vector<Option> options;
  const Options defaults;
  Fields<Options>::visit([&](const char* name, auto member, const char* text) {
    using Member = std::decay_t<decltype(defaults.*member)>;
    for (const Argument& argument : function.arguments)
      if (argument.name == std::string(name))
        return;
    const std::string type = Convert<Member>::annotation();
    options.push_back({name,
                       isUnset(defaults.*member) ? "Optional[" + type + "]"
                       : type == "Doubles"       ? "ArrayLike"
                                                 : type,
                       defaultText(defaults.*member), text});
  });
  addFunction(module, function, options, Fields<Options>::text, body);
}
inline void addFunction(const py::module_& module, const Function& function, const CallBody& body)
{
  addFunction(module, function, {}, "", body);
}

/// Held while something works that the process has only one of: the outputs of a model.
std::mutex& oneAtATime();

/// Points, or a mesh, that must not be empty, with attributes that fit and faces in range.
/// @throws py::value_error that names the argument, std::invalid_argument
Lent<PointSet> lendPoints(const Call& call, const char* argument = "points");
Lent<TriangleMesh> lendMesh(const Call& call, const char* argument = "mesh");
} // namespace fresco::python
