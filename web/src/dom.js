// Elements of the page. Text is always set as text: names come from files, and files may come from anybody.

/** An element with properties, attributes (those that HTML spells with a hyphen, and `role`) and children. */
export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes('-') || name === 'role' || name === 'for') made.setAttribute(name, value);
    else made[name] = value;
  }
  made.append(...children);
  return made;
}

/** 20480 as 20,480. */
export const grouped = (number) => number.toLocaleString('en-GB');

/** `1 pair`, `2 pairs`. */
export const counted = (number, one, many = `${one}s`) => `${grouped(number)} ${number === 1 ? one : many}`;

/** A colour of the style sheet, in the scheme that is on. */
export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
