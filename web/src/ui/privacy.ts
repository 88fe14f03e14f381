// SPDX-License-Identifier: Apache-2.0

/** Where the user's data go, for a page that was opened at this host name. */
export function privacyNote(host: string): string {
  const here = /^(localhost|127(\.\d+){3}|\[::1\])$/.test(host);
  return here
    ? "Video, motion and avatars stay on this computer unless you send the motion somewhere or start Telemime with --address."
    : "Telemime sends video and motion to the pages that are open, such as this one, and motion to where you send it. Your avatar files stay in this browser.";
}
