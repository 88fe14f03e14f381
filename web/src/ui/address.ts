// SPDX-License-Identifier: Apache-2.0
// Addresses of outputs.

/** The limit of the program. */
export const MAX_ADDRESS = 2000;

/**
 * The address as the program shows it: without a user's password, or the secret of a meeting's link.
 * The same as without_password in src/telemime/streaming/url.cpp.
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
    // There is no user before the host. A password that contains "/" ends behind it.
    const hostAndPath = colon < 0 || colon > end || /^[0-9]+$/.test(url.slice(colon + 1, end));
    at = hostAndPath && !/^mqtt/i.test(url) ? -1 : url.lastIndexOf("@");
  }
  return at < 0 || colon < 0 || colon > at ? url : url.slice(0, colon) + url.slice(at);
}
