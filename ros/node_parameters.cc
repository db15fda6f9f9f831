// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "node_parameters.h"

#include "plumbline/base/error.h"

#include <optional>
#include <set>
#include <sstream>
#include <type_traits>
#include <vector>

#include <xmlrpcpp/XmlRpcValue.h>

namespace plumbline::ros_node {
namespace {

using XmlRpc::XmlRpcValue;

const char* NameOfType(XmlRpcValue::Type type) {
  switch (type) {
    case XmlRpcValue::TypeBoolean:
      return "a truth value";
    case XmlRpcValue::TypeInt:
      return "a whole number";
    case XmlRpcValue::TypeDouble:
      return "a number";
    case XmlRpcValue::TypeString:
      return "a text";
    case XmlRpcValue::TypeStruct:
      return "a group";
    case XmlRpcValue::TypeArray:
      return "a list";
    default:
      return "something else";
  }
}

// Reads parameters by name, and remembers the names.
class Reader {
 public:
  explicit Reader(const ros::NodeHandle& own) : own_(own) {}

  template <class T>
  void Read(const std::string& name, XmlRpcValue::Type type, T& value) {
    names_.insert(name);
    XmlRpcValue found;
    if (!own_.getParam(name, found)) return;
    if constexpr (std::is_same_v<T, double>) {
      if (found.getType() == XmlRpcValue::TypeInt) {
        value = static_cast<int&>(found);
        return;
      }
    }
    if (found.getType() != type) {
      throw InputError("~" + name + ": expected " + NameOfType(type) + ", found " +
                       NameOfType(found.getType()));
    }
    value = static_cast<T&>(found);
  }
  void Text(const std::string& name, std::string& value) {
    Read(name, XmlRpcValue::TypeString, value);
  }
  void Flag(const std::string& name, bool& value) { Read(name, XmlRpcValue::TypeBoolean, value); }
  // Stays empty where it is not set.
  void Flag(const std::string& name, std::optional<bool>& value) {
    bool flag = false;
    Flag(name, flag);
    if (own_.hasParam(name)) value = flag;
  }
  // A group of any depth; not valid where there is none.
  XmlRpcValue Group(const std::string& name) {
    names_.insert(name);
    XmlRpcValue found;
    if (own_.getParam(name, found) && found.getType() != XmlRpcValue::TypeStruct) {
      throw InputError("~" + name + ": expected a group, found " + NameOfType(found.getType()));
    }
    return found;
  }

  // What was set for this node and is none of its parameters.
  void CheckNames() const {
    std::vector<std::string> all;
    own_.getParamNames(all);
    const std::string prefix = own_.getNamespace() + "/";
    for (const std::string& full : all) {
      if (full.compare(0, prefix.size(), prefix) != 0) continue;
      const std::string rest = full.substr(prefix.size());
      const std::string name = rest.substr(0, rest.find('/'));
      if (names_.count(name) > 0) continue;
      std::string known;
      for (const std::string& one : names_) known += (known.empty() ? "" : ", ") + one;
      throw InputError("~" + name + ": expected a parameter of this node (" + known + ")");
    }
  }

 private:
  const ros::NodeHandle& own_;
  std::set<std::string> names_;
};

std::string TextOf(const std::string& key, XmlRpcValue& value) {
  std::ostringstream text;
  text.precision(17);
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return static_cast<bool&>(value) ? "true" : "false";
    case XmlRpcValue::TypeInt:
      return std::to_string(static_cast<int&>(value));
    case XmlRpcValue::TypeDouble:
      text << static_cast<double&>(value);
      return text.str();
    case XmlRpcValue::TypeString:
      return static_cast<std::string&>(value);
    default:
      throw InputError("~options/" + key + ": expected a number, a truth value or a text, found " +
                       NameOfType(value.getType()));
  }
}

// ~options/features/line_count is the option features.line_count.
void AddOptions(XmlRpcValue& group, const std::string& prefix, std::vector<std::string>& options) {
  for (auto& entry : group) {
    const std::string key = prefix + entry.first;
    if (entry.second.getType() == XmlRpcValue::TypeStruct) {
      AddOptions(entry.second, key + ".", options);
    } else {
      options.push_back(key + "=" + TextOf(key, entry.second));
    }
  }
}

void CheckTogether(const NodeParameters& p) {
  if (p.slam.sensor != "mono" && p.slam.sensor != "stereo" && p.slam.sensor != "rgbd") {
    throw InputError("~sensor: expected mono, stereo or rgbd, found " + p.slam.sensor);
  }
  if (p.queue_size < 1) {
    throw InputError("~queue_size: expected at least 1, found " + std::to_string(p.queue_size));
  }
  if (!(p.map_period > 0)) {
    throw InputError("~map_period: expected seconds greater than 0, found " +
                     std::to_string(p.map_period));
  }
  if ((p.load || p.localize) && p.map_file.empty()) {
    throw InputError("~map_file: expected a file to load, found none");
  }
}

}  // namespace

NodeParameters ReadParameters(const ros::NodeHandle& own) {
  NodeParameters p;
  Reader reader(own);
  std::string sync = "exact";
  reader.Text("sensor", p.slam.sensor);
  reader.Text("camera", p.slam.camera);
  reader.Flag("rectified", p.slam.rectified);
  reader.Text("config", p.slam.config);
  XmlRpcValue options = reader.Group("options");
  if (options.valid()) AddOptions(options, "", p.slam.options);
  reader.Text("sync", sync);
  if (sync != "exact" && sync != "approximate") {
    throw InputError("~sync: expected exact or approximate, found " + sync);
  }
  p.approximate_sync = sync == "approximate";
  reader.Read("queue_size", XmlRpcValue::TypeInt, p.queue_size);
  reader.Text("map_file", p.map_file);
  reader.Flag("load", p.load);
  reader.Flag("localize", p.localize);
  reader.Text("map_frame", p.map_frame);
  reader.Text("odom_frame", p.odom_frame);
  reader.Text("base_frame", p.base_frame);
  reader.Flag("publish_tf", p.publish_tf);
  reader.Flag("publish_odom_tf", p.publish_odom_tf);
  reader.Read("map_period", XmlRpcValue::TypeDouble, p.map_period);
  reader.CheckNames();
  CheckTogether(p);
  return p;
}

}  // namespace plumbline::ros_node
