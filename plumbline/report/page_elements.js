// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
"use strict";

// Elements of pages, numbers as text, colours.

// An element with attributes and children. Text is always set as text, never read as HTML.
function make(tag, attributes, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on"))
      element.addEventListener(name.slice(2), value);
    else
      element.setAttribute(name, value === true ? "" : value);
  }
  for (const child of children.flat()) {
    if (child !== null && child !== undefined) element.append(child);
  }
  return element;
}

// The colour of a custom property of the style sheet, light or dark as shown now.
function color(name) {
  return getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
}

// The same as a value for style sheets, which follows a change between light and dark.
const paint = (name) => `var(--${name})`;

// A number with `count` significant digits, without exponent.
function digits(value, count = 3) {
  if (value === null || value === undefined || !isFinite(value)) return "–";
  if (value === 0) return "0";
  const magnitude = Math.floor(Math.log10(Math.abs(value)));
  const text = value.toFixed(Math.max(0, Math.min(8, count - 1 - magnitude)));
  return text.replace("-", "−");
}

function whole(value) {
  return value.toLocaleString("en-US");
}

// A length or speed in metres as it is read best.
function lengthUnit(largest) {
  return largest < 0.1 ? {factor: 1000, name: "mm"} : {factor: 1, name: "m"};
}
function metres(value, count = 3) {
  const unit = lengthUnit(Math.abs(value));
  return digits(value * unit.factor, count) + " " + unit.name;
}

// A length in a map: in metres, or in the unit that a map of one camera has of its own.
function lengthInMap(value, metric, count = 3) {
  return metric ? metres(value, count) : digits(value, count) + " units";
}

// A value that tells its listeners when it changes.
class Shared {
  constructor(value) {
    this.value = value;
    this.listeners = [];
  }
  set(value, source) {
    this.value = value;
    for (const listener of this.listeners) listener(value, source);
  }
  listen(listener) {
    this.listeners.push(listener);
  }
}

// A pleasing distance between ticks, 1, 2 or 5 times a power of ten.
function tickStep(span, count) {
  const rough = Math.max(span, 1e-12) / Math.max(count, 1);
  const power = Math.pow(10, Math.floor(Math.log10(rough)));
  return [1, 2, 5, 10].find((factor) => factor * power >= rough * 0.999) * power;
}

// A legend of [{color, text, kind}], kind one of the classes of .key, colour by paint().
function makeLegend(entries) {
  return make(
      "ul", {class: "legend"},
      entries.map(
          (entry) => make(
              "li", {}, make("span", {
                class: "key " + (entry.kind || ""),
                style: `background-color:${entry.color};border-color:${entry.color}`
              }),
              entry.text)));
}

// Buttons of which one is pressed: [{text, value}].
function makeChoice(label, entries, value, onChange) {
  const buttons = entries.map(
      (entry) => make(
          "button", {
            type: "button",
            "aria-pressed": String(entry.value === value),
            onclick: () => {
              buttons.forEach((button, i) => {
                button.setAttribute("aria-pressed", String(entries[i] === entry));
              });
              onChange(entry.value);
            }
          },
          entry.text));
  return make("div", {class: "choice", role: "group", "aria-label": label}, buttons);
}

// Buttons each of which is pressed or not, at first pressed: [{text, value}].
function makeToggles(label, entries, onChange) {
  const buttons = entries.map(({text, value, off, title}) => {
    const press = (event) => {
      const pressed = event.target.getAttribute("aria-pressed") !== "true";
      event.target.setAttribute("aria-pressed", String(pressed));
      onChange(value, pressed);
    };
    const attributes = {type: "button", "aria-pressed": String(!off), onclick: press};
    if (title) attributes.title = title;
    return make("button", attributes, text);
  });
  return make("div", {class: "choice", role: "group", "aria-label": label}, buttons);
}
