// SPDX-License-Identifier: Apache-2.0

/** Notices when another version of the program greets the page than at first: the page is that of the old one. */
export class VersionWatch {
  private first: string | null = null;

  changed(version: string): boolean {
    this.first ??= version;
    return version !== this.first;
  }
}
