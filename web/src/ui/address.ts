// SPDX-License-Identifier: Apache-2.0
// Addresses of outputs.

/** Like the program's limit. */
export const LONGEST_ADDRESS = 2000;

/**
 * The address as the program shows it: without the password of a user, or the secret of a room's link.
 * The same as without_password in src/telemime/network/url.cpp.
 */
export function withoutPassword(given: string): string {
  const secret = given.indexOf(/^http/i.test(given) ? "#" : "#k=");
  const url = secret < 0 ? given : given.slice(0, secret);
  const scheme = url.indexOf("://");
  if (scheme < 0) return url;
  const start = scheme + 3;
  const behind = url.slice(start).search(/[/?#]/);
  const end = behind < 0 ? url.length : start + behind;
  const colon = url.indexOf(":", start);
  let at = url.slice(0, end).lastIndexOf("@");
  if (at < start) {
    // No user in the right place. A password with a "/" in it would be one in the wrong place.
    const hostAndPath = colon < 0 || colon > end || /^[0-9]+$/.test(url.slice(colon + 1, end));
    at = hostAndPath && !/^mqtt/i.test(url) ? -1 : url.lastIndexOf("@");
  }
  return at < 0 || colon < 0 || colon > at ? url : url.slice(0, colon) + url.slice(at);
}
